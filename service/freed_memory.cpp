#include "telltale/service/freed_memory.hpp"

#include <chrono>
#include <mutex>

#include <malloc.h>

#include <spdlog/spdlog.h>

namespace telltale {

void ReturnFreedMemory() {
  using Clock = std::chrono::steady_clock;
  // A second caller would find little to give back. Under a sanitizer, which has a heap of its own,
  // the first call also sets up that of the C library, which must not happen twice at once.
  static std::mutex one_at_a_time;
  const std::lock_guard lock(one_at_a_time);
  const auto begun = Clock::now();
  malloc_trim(0);
  const std::chrono::duration<double> took = Clock::now() - begun;
  spdlog::debug("freed memory is given back in {:.3f} s", took.count());
}

}  // namespace telltale
