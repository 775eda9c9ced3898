#pragma once

#include <chrono>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>

namespace telltale {

/// Counts how often the clock of a vehicle has jumped: the newest time of its window steps by more
/// than the limit, ahead or back, and by another span than has passed here since the sample before.
/// After a silence both have gone on alike.
class ClockJumps {
 public:
  using Clock = std::chrono::steady_clock;

  /// Requires: a limit in seconds, WindowLimits::clock_jump_s.
  explicit ClockJumps(double limit_s) : limit_s_(limit_s) {}

  /// A kept sample that arrived at `now` has moved the newest time of the window by `step_s`.
  /// Says nothing of the first: how long the vehicle had been silent is not known.
  void Note(double step_s, Clock::time_point now) {
    const auto before = std::exchange(newest_, now);
    if (!before) return;
    const double passed_s = std::chrono::duration<double>(now - *before).count();
    if (std::abs(step_s) > limit_s_ && std::abs(step_s - passed_s) > limit_s_) ++count_;
  }

  std::uint64_t count() const { return count_; }

 private:
  double limit_s_;
  std::optional<Clock::time_point> newest_;
  std::uint64_t count_ = 0;
};

}  // namespace telltale
