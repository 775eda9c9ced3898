#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include "telltale/core/data/samples.hpp"

namespace telltale {

/// Checks one sensor for a reading that repeats bit for bit although the commands changed.
/// Sample: GnssFix or HeadingSample. Units: seconds, microseconds.
template <class Sample>
class StuckSensorCheck {
 public:
  /// Takes in a reading; `command` is the newest one, if any.
  void AddReading(const Sample& sample, const std::optional<ThrusterSample>& command) {
    if (reading_ && SameReading(*reading_, sample)) return;
    reading_ = sample;
    command_at_change_ = command;
    commanded_s_ = 0.0;
  }

  /// Takes in that `held` was in force for `duration_s`.
  void AddCommand(const ThrusterSample& held, double duration_s) {
    if (!command_at_change_) command_at_change_ = held;
    if (!SameCommand(held, *command_at_change_)) {
      commanded_s_ += std::min(duration_s, kLongestHoldS);
    }
  }

  /// Whether commands unlike that at the last new reading were in force for more than `after_s`.
  bool IsStuck(double after_s) const { return commanded_s_ > after_s; }

 private:
  // Pulse widths this close to those at the last new reading command the same motion.
  static constexpr double kSameCommandUs = 50.0;
  // A command counts for no longer than this without a newer one.
  static constexpr double kLongestHoldS = 1.0;

  static bool SameCommand(const ThrusterSample& a, const ThrusterSample& b) {
    return std::abs(a.port_us - b.port_us) <= kSameCommandUs &&
           std::abs(a.starboard_us - b.starboard_us) <= kSameCommandUs;
  }

  std::optional<Sample> reading_;
  std::optional<ThrusterSample> command_at_change_;
  double commanded_s_ = 0.0;
};

}  // namespace telltale
