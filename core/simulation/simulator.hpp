#pragma once

#include <functional>
#include <vector>

#include "telltale/core/data/samples.hpp"
#include "telltale/core/vessel/motion.hpp"
#include "telltale/core/vessel/propellers.hpp"
#include "telltale/core/vessel/vessel_model.hpp"

namespace telltale {

/// The state of a simulated boat.
struct VesselState {
  Eta eta;
  Nu nu;
  ThrustRegressors thrust = {};  ///< what the thrusters deliver now; unused in the static structure
};

/// The pose `step_s` later, following the mean of the velocities and headings before and after.
Eta NextPose(const Eta& eta, const Nu& before, const Nu& after, double step_s);

/// Advances a boat by `step_s` under a held command. kForwardEuler models take exactly
/// nu + step nu_dot (step must then be their sampling period); kContinuous ones a Runge-Kutta step
/// of order four. The pose follows the mean of the two velocities and headings (trapezoid).
/// Requires: a named discretisation.
VesselState Advance(const VesselModel& model, const VesselState& state,
                    const PropellerCommand& delta, double step_s);

/// A held command that starts at time_s.
struct TimedCommand {
  double time_s = 0.0;
  PropellerCommand delta;
};

struct TimedState {
  double time_s = 0.0;
  VesselState state;
  PropellerCommand delta;
};

/// States at every multiple of `step_s` from the first command to `end_s`. Each step runs under the
/// command that is newest at its start.
/// Requires: commands in order of time, at least one; end_s not before the first.
std::vector<TimedState> Simulate(const VesselModel& model, const VesselState& initial,
                                 const std::vector<TimedCommand>& commands, double end_s,
                                 double step_s);

}  // namespace telltale
