#pragma once

#include <filesystem>

namespace telltale {

/// Holds a state directory for this process alone, by an advisory lock that ends with the process
/// however it ends. Throws std::runtime_error, which names the directory and the process that holds
/// it, where another process does, and std::system_error where the disk refuses.
class DirectoryLock {
 public:
  /// Creates the directory where it is missing.
  explicit DirectoryLock(const std::filesystem::path& directory);
  DirectoryLock(const DirectoryLock&) = delete;
  DirectoryLock& operator=(const DirectoryLock&) = delete;
  ~DirectoryLock();

 private:
  int file_;
};

}  // namespace telltale
