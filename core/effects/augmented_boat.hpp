#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "telltale/core/data/held_commands.hpp"
#include "telltale/core/effects/augmented_model.hpp"
#include "telltale/core/effects/recording_frame.hpp"
#include "telltale/core/vessel/motion.hpp"
#include "telltale/core/vessel/vehicle.hpp"

namespace telltale {

/// What the propellers of each side give, port first.
using SideThrust = std::array<NuDot, 2>;

/// What they give through one step: mean accelerations.
struct Drive {
  SideThrust thrust;
  double load = 0.0;  ///< mean squared command of the two
};

struct Pose {
  Eta eta;
  Nu nu;
};

/// How many steps a sampling period takes: one of a kForwardEuler model, else as many as are no
/// longer than a fifth of a second.
std::size_t StepsPerRow(const VesselModel& model, double sampling_period_s);

/// A model and its effects, ready to simulate.
/// Model: nu_dot = body(nu_r) + sum over sides of share T + nu_c_dot + added accelerations,
/// docs/concepts/diagnosis.md (81), with nu_c_dot = (r v_c, -r u_c, 0) of a uniform current; T is
/// of shafts that follow the commands, delayed, slewed and altered, through the effects' lags, and
/// lags itself by the model's own. kForwardEuler models step as they were made, kContinuous ones by
/// a Runge-Kutta step of order four with the heading of the middle of the step and the current of
/// the place where the step begins; a step is halved where the damping would make it grow.
/// Requires: a model with all three equations.
class AugmentedBoat {
 public:
  AugmentedBoat(AugmentedModel model, const RecordingFrame& frame,
                const HullParticulars& hull = {});

  /// The drives of `steps` steps from `from_s`, thrusters having followed the commands before.
  std::vector<Drive> DrivesAlong(const HeldCommands& commands, double from_s, double step_s,
                                 std::size_t steps) const;

  /// Whether the drives of the two boats are the same whatever the commands: they differ in no
  /// thrust coefficient, and in no effect on commands or shafts.
  bool IsDrivenLike(const AugmentedBoat& other) const;

  /// The boat `step_s` after `from` at `time_s`.
  Pose Advance(const Pose& from, const Drive& drive, double time_s, double step_s) const;

  /// The boat at `from_s` and after each of the drives.
  std::vector<Pose> Simulate(const Pose& from, std::span<const Drive> drives, double from_s,
                             double step_s) const;

  /// What the compass makes of a true heading, how fast that changes with the heading, and the
  /// true heading behind a measured one.
  double MeasuredHeadingRad(double psi_rad) const;
  double MeasuredHeadingSlope(double psi_rad) const;
  double TrueHeadingRad(double measured_rad) const;
  LeverArm AntennaShift() const { return antenna_shift_; }
  double LatencyS() const { return latency_s_; }
  const VesselModel& Model() const { return model_.model; }

 private:
  /// The velocity through the water, and what its change gives the boat.
  struct Flow {
    Nu nu_r;
    NuDot nu_c_dot;
  };

  const std::vector<ModelledEffect>& Hooked(Hook hook) const {
    return hooked_[static_cast<std::size_t>(hook)];
  }
  SideThrust SteadyThrust(const PropellerCommand& delta) const;
  Flow FlowAt(const Nu& nu, const Eta& eta) const;
  /// Leaves the propellers the share of their thrust that they give in reverse and by the effects.
  void ShareThrust(InstantState& instant) const;
  NuDot Acceleration(const Nu& nu, const Eta& eta, const Drive& drive, double time_s) const;

  AugmentedModel model_;
  std::array<std::vector<ModelledEffect>, 5> hooked_;  ///< by the hook they override
  RecordingFrame frame_;
  HullScale hull_scale_;
  HullTerms hull_;  ///< coefficients
  std::array<std::array<double, 4>, 3> thrust_{};
  std::vector<double> shaft_lags_s_;
  double output_travel_s_ = 0.0;
  double delay_s_ = 0.0;
  LeverArm antenna_shift_;
  double latency_s_ = 0.0;
  Eigen::Vector2d current_ = Eigen::Vector2d::Zero();
  Eigen::Matrix2d current_gradient_ = Eigen::Matrix2d::Zero();
};

}  // namespace telltale
