#pragma once

#include <chrono>

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
  double begun_s_ =
      std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
};

}  // namespace telltale
