#pragma once

#include <initializer_list>
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

/// The onset of a drift that several tests may find: the earliest that any has told since the
/// drift goes on. It does not move where another test finds the same drift later.
class EarliestOnset {
 public:
  /// What each test tells now; nothing where it finds no drift.
  void Note(std::initializer_list<std::optional<OnsetTime>> told) {
    std::optional<OnsetTime> earliest;
    for (const auto& onset : told) {
      if (onset && (!earliest || onset->unix_s < earliest->unix_s)) earliest = onset;
    }
    const bool goes_on = earliest.has_value();
    if (!goes_on || !onset_ || earliest->unix_s < onset_->unix_s) onset_ = earliest;
  }

  const std::optional<OnsetTime>& onset() const { return onset_; }

 private:
  std::optional<OnsetTime> onset_;
};

}  // namespace telltale
