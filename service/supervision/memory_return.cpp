#include "telltale/service/supervision/memory_return.hpp"

#include <chrono>

#include <malloc.h>

#include <spdlog/spdlog.h>

namespace telltale {

void MemoryReturn::Run(const std::stop_token& stop) {
  constexpr std::chrono::minutes kPeriod{1};
  using Clock = std::chrono::steady_clock;
  std::unique_lock lock(mutex_);
  while (!wake_.wait_for(lock, stop, kPeriod, [&stop] { return stop.stop_requested(); })) {
    const auto begun = Clock::now();
    malloc_trim(0);
    const std::chrono::duration<double> took = Clock::now() - begun;
    spdlog::debug("free memory is given back in {:.3f} s", took.count());
  }
}

}  // namespace telltale
