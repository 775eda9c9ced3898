#pragma once

#include <condition_variable>
#include <mutex>
#include <stop_token>
#include <thread>

namespace telltale {

/// Gives the memory back to the system, once a minute and on a thread of its own, that has been
/// freed and that the heaps of glibc keep. Each thread has a heap, and one that computes leaves
/// holes of tens of megabytes in its own; they would add up with the hours to several times what is
/// in use.
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
