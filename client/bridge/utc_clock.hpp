#pragma once

#include <chrono>

#include "telltale/client/fleet/unix_now.hpp"

namespace telltale {

/// UTC in seconds, by a clock that is set once and never goes back.
class UtcClock {
 public:
  double Now() const {
    const std::chrono::duration<double> since = std::chrono::steady_clock::now() - steady_;
    return begun_s_ + since.count();
  }

 private:
  std::chrono::steady_clock::time_point steady_ = std::chrono::steady_clock::now();
  double begun_s_ = UnixNow();
};

}  // namespace telltale
