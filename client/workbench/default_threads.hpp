#pragma once

#include <algorithm>
#include <cstddef>
#include <thread>

namespace telltale {

/// As many threads as the machine runs at once, within what options allow.
inline std::size_t DefaultThreads() {
  constexpr unsigned kMostThreads = 256;
  return std::clamp(std::thread::hardware_concurrency(), 1u, kMostThreads);
}

}  // namespace telltale
