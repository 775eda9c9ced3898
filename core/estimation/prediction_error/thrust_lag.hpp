#pragma once

#include <cstddef>
#include <vector>

#include "telltale/core/data/held_commands.hpp"
#include "telltale/core/vessel/fossen_model.hpp"

namespace telltale {

/// Lagged propeller regressors over one integration step with their derivatives.
struct ThrustStep {
  FossenDynamics::Thrusts mean[2];  ///< over the step; port, starboard
  /// The integral of (thrust - mean) times the time left in the step: what the way made by the end
  /// of the step has beyond that under the mean.
  FossenDynamics::Thrusts early[2];
  FossenDynamics::Thrusts by_dead_bands[2];
  FossenDynamics::Thrusts by_time_constant[2];
  FossenDynamics::Thrusts by_delay[2];
};

/// The thrust regressors of both propellers over successive steps: (f:d, f:d^2, r:d, r:d^2) beyond
/// the dead band, each through a first-order lag, the commands `delay_s` behind their stamps.
/// Model: docs/concepts/physical-model.md (105), (109). Exact for held commands.
class ThrustLag {
 public:
  struct Lag {
    DeadZone dead_zone;
    double time_constant_s = 0.1;  ///< > 0
    double delay_s = 0.0;
  };

  ThrustLag(const HeldCommands& commands, const Lag& lag, double start_s);

  /// The step from the end of the last one (first: start_s) to `end_s`. Requires: end_s later.
  ThrustStep Until(double end_s);

 private:
  struct Target {
    FossenDynamics::Thrusts value[2];
    FossenDynamics::Thrusts by_dead_bands[2];
  };

  Target TargetOf(const PropellerCommand& command) const;
  void Enter(std::size_t piece);

  std::vector<double> times_s_;
  std::vector<PropellerCommand> commands_;
  Lag lag_;
  double now_s_;
  std::size_t piece_ = 0;
  Target target_;
  Target state_;
  FossenDynamics::Thrusts state_by_time_constant_[2];
};

}  // namespace telltale
