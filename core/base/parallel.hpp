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
/// and never on more than the machine has. Which thread gets which i is left to chance, so bodies
/// share nothing they write. The first exception ends the loop early and is thrown again here. The
/// standard library's threads, not oneTBB's: the thread sanitizer sees how these synchronise,
/// whereas inside Debian's libtbb it does not, and the suppression that asks for would hide races
/// of the body too.
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
