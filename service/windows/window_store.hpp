#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "telltale/core/data/samples.hpp"

namespace SQLite {
class Database;
}

namespace telltale {

/// The windows of the fleet on disk, in compressed chunks with checksums, in windows.sqlite of the
/// state directory. What was saved outlives the process; a loss of power may take the newest chunks
/// with it. Throws SQLite::Exception where the disk refuses. Not thread safe.
class WindowStore {
 public:
  struct Chunk {
    std::string vehicle_id;
    Recording samples;
  };

  /// Creates the database where it is missing. One that SQLite finds damaged is set aside as
  /// windows.sqlite.damaged-TIME, what can be read is kept, and the log says so.
  explicit WindowStore(const std::filesystem::path& directory);
  ~WindowStore();
  WindowStore(WindowStore&&) noexcept;
  WindowStore& operator=(WindowStore&&) noexcept;

  struct Limits {
    double duration_s = 0.0;       ///< before the newest sample, by the vehicle's clock
    std::int64_t most_chunks = 0;  ///< of a vehicle; where its clock goes back, this bounds them
  };

  /// Saves the chunks in one transaction, and drops of these vehicles what is beyond the limits.
  void Save(const std::vector<Chunk>& chunks, const Limits& limits);

  /// Hands each chunk of a vehicle to `take`, oldest first. Returns how many cannot be read.
  std::size_t Load(const std::string& vehicle_id,
                   const std::function<void(const Recording&)>& take) const;

 private:
  void Insert(const Chunk& chunk, const Limits& limits);

  std::unique_ptr<SQLite::Database> database_;
};

}  // namespace telltale
