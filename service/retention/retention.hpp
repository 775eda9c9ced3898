#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>

#include "telltale/service/retention/store_retention.hpp"

namespace telltale {

/// What retention has done since the daemon started.
struct RetentionActivity {
  RetentionPass last;           ///< the last pass
  RemovalCounts removed;        ///< of all passes
  std::size_t limit_bytes = 0;  ///< of the store; 0: there is none
};

/// Keeps the store within its limits: at start and once a period, on a thread of its own. Each
/// pass that removes something is a line in the log; so is a fault of the database, and that the
/// size cannot be held, each when it begins and when it ends. Thread safe.
class Retention {
 public:
  explicit Retention(StoreRetention store);
  Retention(const Retention&) = delete;
  Retention& operator=(const Retention&) = delete;
  ~Retention();  ///< ends the thread

  RetentionActivity Activity() const;

 private:
  void Run();
  void Pass();
  void Log(const RetentionPass& pass);

  StoreRetention store_;
  const std::chrono::duration<double> period_;
  bool passed_last_time_ = true;
  mutable std::mutex mutex_;  // of what follows
  RetentionActivity activity_;
  std::condition_variable wake_;
  bool stopping_ = false;
  std::thread thread_;
};

}  // namespace telltale
