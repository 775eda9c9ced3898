#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "telltale/core/base/random.hpp"

struct sqlite3_vfs;

namespace telltale {

/// Records what SQLite writes to its files and when it asks that it be on the disk, of every
/// database that is opened while this stands. From that it makes the files as a loss of power may
/// leave them: what was written before the last such request is there; of what was written since,
/// any sector of 512 bytes may be missing. A file that was deleted is gone with the next such
/// request of any file, as where the file system logs its names in order; SQLite asks for that too
/// with the first of each log. A disk that says too early that it has written is not simulated. One
/// at a time. Thread safe.
class RecordedDisk {
 public:
  RecordedDisk();
  RecordedDisk(const RecordedDisk&) = delete;
  RecordedDisk& operator=(const RecordedDisk&) = delete;
  ~RecordedDisk();  ///< no database is open

  /// How much has been recorded.
  std::size_t Now() const;

  /// Writes the files of the folder `from` into `to`, as they may be where the power is cut once
  /// `now` was recorded.
  void LeaveAfterCut(std::size_t now, const std::filesystem::path& from,
                     const std::filesystem::path& to, RandomEngine& random) const;

  // What SQLite does to a file.
  void Write(const std::string& file, std::string_view bytes, std::size_t offset);
  void Truncate(const std::string& file, std::size_t size);
  void Sync(const std::string& file);
  void Delete(const std::string& file);

  sqlite3_vfs& real() const { return real_; }

 private:
  enum class Kind { kWrite, kTruncate, kSync, kDelete };

  struct Operation {
    Kind kind = Kind::kWrite;
    std::string file;
    std::string bytes;       ///< of a write
    std::size_t offset = 0;  ///< of a write; the size, where it is truncated
  };
  using Files = std::map<std::string, std::string>;  ///< contents by path

  void Record(Operation operation);
  static void Apply(const Operation& operation, Files& files);
  static void ApplyInPart(const Operation& operation, Files& files, RandomEngine& random);

  sqlite3_vfs& real_;
  mutable std::mutex mutex_;  // of what follows
  std::vector<Operation> operations_;
};

}  // namespace telltale
