#pragma once

#include <condition_variable>
#include <mutex>
#include <stop_token>
#include <thread>

namespace telltale {

/// Gives freed memory back to the system once a minute, on a thread of its own: what is freed
/// outside of jobs, as by windows and by the pages. Jobs do it themselves.
class MemoryReturn {
 public:
  MemoryReturn() : thread_([this](const std::stop_token& stop) { Run(stop); }) {}
  MemoryReturn(const MemoryReturn&) = delete;
  MemoryReturn& operator=(const MemoryReturn&) = delete;
  ~MemoryReturn() = default;  ///< ends the thread

 private:
  void Run(const std::stop_token& stop);

  std::mutex mutex_;  // of wake_
  std::condition_variable_any wake_;
  std::jthread thread_;  // last: it uses the others
};

}  // namespace telltale
