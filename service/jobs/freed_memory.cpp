#include "telltale/service/jobs/freed_memory.hpp"

#include <chrono>

#include <malloc.h>

#include <spdlog/spdlog.h>

namespace telltale {

void ReturnFreedMemory() {
  using Clock = std::chrono::steady_clock;
  const auto begun = Clock::now();
  malloc_trim(0);
  const std::chrono::duration<double> took = Clock::now() - begun;
  spdlog::debug("freed memory is given back in {:.3f} s", took.count());
}

}  // namespace telltale
