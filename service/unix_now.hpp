#pragma once

#include <chrono>

namespace telltale {

/// Seconds since 1970 by the system's clock.
inline double UnixNow() {
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  return std::chrono::duration<double>(now).count();
}

}  // namespace telltale
