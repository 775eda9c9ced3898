#pragma once

#include <optional>

#include "telltale/client/fleet/unix_now.hpp"

namespace telltale {

struct OnsetTime {
  double unix_s = 0.0;
  double vehicle_s = 0.0;  ///< by the vehicle's clock
};

/// When what goes on now has begun.
class OnsetClock {
 public:
  /// Whether it goes on at `vehicle_s`.
  void Note(bool goes_on, double vehicle_s) {
    if (!goes_on) {
      onset_.reset();
    } else if (!onset_) {
      onset_ = OnsetTime{UnixNow(), vehicle_s};
    }
  }

  const std::optional<OnsetTime>& onset() const { return onset_; }

 private:
  std::optional<OnsetTime> onset_;
};

}  // namespace telltale
