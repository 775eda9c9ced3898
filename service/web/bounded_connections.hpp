#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

#include "telltale/service/web/httplib.hpp"

namespace telltale {

/// Serves at most so many connections at a time, each on a thread of its own. The next one waits
/// in the backlog of the operating system, so that a flood takes neither memory nor descriptors.
class BoundedConnections : public httplib::TaskQueue {
 public:
  explicit BoundedConnections(std::size_t limit);

  /// Waits for a free thread, unless it is to shut down.
  void enqueue(std::function<void()> serve) override;
  void shutdown() override;

 private:
  void Run();

  std::mutex mutex_;  // of what follows
  std::condition_variable queued_;
  std::condition_variable taken_;
  std::deque<std::function<void()>> waiting_;
  std::size_t idle_ = 0;
  bool stopping_ = false;
  std::vector<std::thread> threads_;
};

}  // namespace telltale
