#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <stop_token>
#include <string>
#include <thread>

#include "telltale/service/monitoring/daemon_activity.hpp"

namespace telltale {

/// Tells the service manager that the daemon is ready, how it stands, and, while its threads
/// advance, that it is alive. On a thread of its own, which asks the daemon several times a
/// watchdog period: where a part of the daemon never answers, there is no sign of life either.
class Supervision {
 public:
  /// `look` runs on the thread.
  explicit Supervision(std::function<DaemonActivity()> look);
  Supervision(const Supervision&) = delete;
  Supervision& operator=(const Supervision&) = delete;
  ~Supervision() = default;  ///< ends the thread

 private:
  void Run(const std::stop_token& stop);
  void Look();

  const std::function<DaemonActivity()> look_;
  bool told_ready_ = false;  // of the thread, as the next
  std::string told_status_;
  std::mutex mutex_;  // of wake_
  std::condition_variable_any wake_;
  std::jthread thread_;  // last: it uses the others
};

}  // namespace telltale
