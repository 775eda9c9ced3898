#pragma once

#include <chrono>

namespace telltale {

/// Seconds since 1970-01-01 00:00 UTC by the clock of the system.
inline double UnixNow() {
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  return std::chrono::duration<double>(now).count();
}

}  // namespace telltale
