#pragma once

#include <cstddef>
#include <cstdio>
#include <memory>

#include <unistd.h>

namespace spdlog::details {
class thread_pool;
}  // namespace spdlog::details

namespace telltale {

/// The log of the daemon: the default logger of spdlog, which writes on a thread of its own.
/// Nobody who logs waits for whoever reads. While that one does not read, the newest
/// `most_waiting` lines are kept, and a line says later how many older ones were left out. One at a
/// time.
class DaemonLog {
 public:
  /// Writes to this descriptor, which others may use too. Throws std::system_error where that
  /// cannot be done.
  explicit DaemonLog(int descriptor = STDERR_FILENO, std::size_t most_waiting = 1024);
  DaemonLog(const DaemonLog&) = delete;
  DaemonLog& operator=(const DaemonLog&) = delete;

  /// Writes what waits, unless nobody reads it within two seconds. What is logged later is lost.
  ~DaemonLog();

 private:
  std::FILE* const file_;
  std::shared_ptr<spdlog::details::thread_pool> writing_;
};

}  // namespace telltale
