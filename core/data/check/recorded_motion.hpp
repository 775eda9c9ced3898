#pragma once

#include <cstddef>
#include <vector>

#include "telltale/core/data/heading_unwrap.hpp"
#include "telltale/core/data/samples.hpp"
#include "telltale/core/data/time_series.hpp"
#include "telltale/core/vessel/vehicle.hpp"

namespace telltale {

/// The commands behind a first-order lag, linear between their stamps and held beyond the ends.
/// They are gone through once, so that no copy of them stands in memory. Requires: a command.
class LaggedCommands {
 public:
  LaggedCommands(const std::vector<ThrusterSample>& thrusters, const Vehicle& vehicle,
                 double lag_s);

  /// Requires: a time not before the one asked for last.
  PropellerCommand At(double t);

 private:
  PropellerCommand Told(std::size_t i) const;
  void Advance();

  const std::vector<ThrusterSample>& thrusters_;
  const Vehicle& vehicle_;
  double lag_s_;
  std::size_t at_ = 0;     // the command that comes next
  PropellerCommand told_;  // at its stamp, without the lag
  PropellerCommand next_;  // at its stamp
  PropellerCommand last_;  // at the stamp before
};

/// The boat's velocity over one chord between fixes.
struct Velocity {
  double time_s = 0.0;
  double span_s = 0.0;
  double north_mps = 0.0;
  double east_mps = 0.0;
};

/// Headings, unwrapped, at the times of the samples, which it borrows. Requires: a heading.
class HeadingSeries {
 public:
  /// Of what `read` makes of the degrees that were recorded.
  template <class Read>
  HeadingSeries(const std::vector<HeadingSample>& heading, Read read) : heading_(heading) {
    psi_rad_.reserve(heading.size());
    for (const HeadingSample& sample : heading) {
      psi_rad_.push_back(UnwrappedBehind(psi_rad_, read(sample.heading_deg)));
    }
  }

  double StartTime() const { return heading_.front().time_s; }
  double EndTime() const { return heading_.back().time_s; }
  bool Covers(double t) const { return StartTime() <= t && t <= EndTime(); }

  /// The time of the first sample that is later than `t`. Requires: there is one.
  double TimeAfter(double t) const { return heading_[LaterThan(t + kSameInstantS)].time_s; }

  /// Linear between the neighbours of `t`, held beyond the ends.
  double At(double t) const;

 private:
  std::size_t LaterThan(double t) const;

  const std::vector<HeadingSample>& heading_;
  std::vector<double> psi_rad_;
};

/// What a recording shows of the boat's motion and of its commands, which it borrows. Requires: two
/// samples of each channel.
class RecordedMotion {
 public:
  static constexpr double kYawLagS = 1.0;       ///< of a small boat's yaw rate behind its commands
  static constexpr double kSpeedLagS = 3.0;     ///< and of its speed
  static constexpr double kChordS = 1.0;        ///< over which a velocity is taken
  static constexpr double kWidestChordS = 3.0;  ///< no velocity and no yaw rate across a wider gap
  static constexpr double kSlowest = 0.3;       ///< m/s, below it a course is mostly noise
  static constexpr double kAhead = 0.1;         ///< mean command that counts as pushing ahead
  /// Independent samples without which nothing is told.
  static constexpr double kFewestEffective = 4.0;

  RecordedMotion(const std::vector<GnssFix>& gnss, const std::vector<HeadingSample>& heading,
                 const std::vector<ThrusterSample>& thrusters, const Vehicle& vehicle);

  const std::vector<HeadingSample>& Headings() const { return heading_; }
  const std::vector<Velocity>& Velocities() const { return velocities_; }
  HeadingSeries Psi() const {
    return {heading_, [](double heading_deg) { return heading_deg; }};
  }
  LaggedCommands CommandsAtYaw() const { return {thrusters_, vehicle_, kYawLagS}; }
  LaggedCommands CommandsAtSpeed() const { return {thrusters_, vehicle_, kSpeedLagS}; }

  /// Independent samples of each: one in two lags.
  double EffectiveYawRates() const { return turning_s_ / (2.0 * kYawLagS); }
  double EffectiveVelocities() const { return moving_s_ / (2.0 * kSpeedLagS); }

 private:
  const std::vector<HeadingSample>& heading_;
  const std::vector<ThrusterSample>& thrusters_;
  const Vehicle& vehicle_;
  std::vector<Velocity> velocities_;
  double moving_s_ = 0.0;
  double turning_s_ = 0.0;
};

}  // namespace telltale
