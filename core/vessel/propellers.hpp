#pragma once

#include <array>
#include <string_view>

namespace telltale {

/// The map from one thruster's pulse width to the normalised command delta. Units: microseconds.
/// Assumes: full_forward and full_reverse lie on opposite sides of neutral; a reversed channel has
/// full_forward_us below neutral_us.
struct PwmChannel {
  double neutral_us = 1500.0;
  double full_forward_us = 1900.0;
  double full_reverse_us = 1100.0;

  /// delta in [-1, 1], positive forward, clipped at full command; piecewise linear about neutral.
  double Normalise(double pulse_us) const;

  /// The pulse width that Normalise maps to `delta`, for delta in [-1, 1].
  double PulseWidth(double delta) const;

  bool operator==(const PwmChannel&) const = default;
};

/// Normalised commands of the two propellers, each in [-1, 1], positive forward.
struct PropellerCommand {
  double port = 0.0;
  double starboard = 0.0;

  double Mean() const { return 0.5 * (port + starboard); }
  double Difference() const { return port - starboard; }
};

/// The widest dead zone that is estimated or accepted, as a share of full command.
inline constexpr double kWidestDeadZone = 0.3;

/// Commands between the two limits give no thrust; beyond them thrust counts from the limit.
/// Assumes: -kWidestDeadZone <= reverse <= 0 <= forward <= kWidestDeadZone. Zeros mean no dead
/// zone. Source: the paper, remark on the T200's dead zone; docs/concepts/model.md (7).
struct DeadZone {
  double forward = 0.0;
  double reverse = 0.0;

  /// The command less the dead zone, which is what the thrust curve takes.
  double Apply(double delta) const;
  PropellerCommand Apply(const PropellerCommand& delta) const;

  bool operator==(const DeadZone&) const = default;
};

/// A command this close to neutral turns no propeller. A neutral stated a few microseconds off then
/// does not make a boat at rest seem to run one side in reverse.
inline constexpr double kIdleCommand = 0.01;

/// The direction in which each propeller turns, port first: R reverse (delta < -kIdleCommand), F
/// forward or idle.
enum class PropellerRegion { kFF, kFR, kRF, kRR };

inline constexpr std::array kPropellerRegions = {PropellerRegion::kFF, PropellerRegion::kFR,
                                                 PropellerRegion::kRF, PropellerRegion::kRR};

PropellerRegion RegionOf(const PropellerCommand& command);

/// "FF", "FR", "RF" or "RR".
std::string_view Name(PropellerRegion region);

}  // namespace telltale
