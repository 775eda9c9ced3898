#pragma once

#include <cstdint>

namespace telltale {

/// What this process takes of the machine.
struct ProcessUsage {
  double cpu_s = 0.0;  ///< user and system, of all threads, since its start
  std::uint64_t resident_bytes = 0;
  std::uint64_t open_descriptors = 0;
};

/// By getrusage() and Linux's /proc; zero where that cannot be read.
ProcessUsage ReadProcessUsage();

}  // namespace telltale
