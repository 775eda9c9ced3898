#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <stop_token>
#include <string>
#include <thread>

#include "telltale/service/monitoring/daemon_activity.hpp"
#include "telltale/service/supervision/liveness.hpp"

namespace telltale {

/// A line for `systemctl status`: "serving 12 vehicles; 3 requests wait, 1 is worked on".
std::string StatusLine(const DaemonActivity& activity);

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
  Liveness liveness_;  // of the thread, as the next two
  bool told_ready_ = false;
  std::string told_status_;
  std::mutex mutex_;  // of wake_
  std::condition_variable_any wake_;
  std::jthread thread_;  // last: it uses the others
};

}  // namespace telltale
