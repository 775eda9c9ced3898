#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace telltale {

/// Calls body(i) once for each i in [0, count) on up to `threads` threads, the caller's among them,
/// and on no more than the machine has.
/// Assumes: bodies share nothing that they write, since any thread may run any i.
/// The first exception ends the loop early and is thrown again here.
/// The threads are the standard library's and not oneTBB's: the thread sanitizer sees how these
/// synchronise. Inside Debian's libtbb it does not, and a suppression would hide races of the body.
template <class Body>
void ForEachIndex(std::size_t count, std::size_t threads, const Body& body) {
  std::atomic<std::size_t> next = 0;
  std::mutex mutex;
  std::exception_ptr first_failure;
  const auto work = [&] {
    try {
      for (std::size_t i = next++; i < count; i = next++) body(i);
    } catch (...) {
      next = count;
      const std::lock_guard lock(mutex);
      if (!first_failure) first_failure = std::current_exception();
    }
  };
  {
    const std::size_t machine = std::max(1U, std::thread::hardware_concurrency());
    std::vector<std::jthread> others;
    for (std::size_t i = 1; i < std::min({threads, machine, count}); ++i) others.emplace_back(work);
    work();
  }
  if (first_failure) std::rethrow_exception(first_failure);
}

}  // namespace telltale
