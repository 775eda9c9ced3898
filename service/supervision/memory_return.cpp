#include "telltale/service/supervision/memory_return.hpp"

#include <chrono>

#include "telltale/service/freed_memory.hpp"

namespace telltale {

void MemoryReturn::Run(const std::stop_token& stop) {
  constexpr std::chrono::minutes kPeriod{1};
  std::unique_lock lock(mutex_);
  while (!wake_.wait_for(lock, stop, kPeriod, [&stop] { return stop.stop_requested(); })) {
    ReturnFreedMemory();
  }
}

}  // namespace telltale
