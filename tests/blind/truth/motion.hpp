#pragma once

#include "environment.hpp"
#include "scenario.hpp"

namespace blind::truth {

/// The boat as it moves: velocities over ground in body axes, shaft speeds in sqrt(N).
struct State {
  double north_m = 0.0;
  double east_m = 0.0;
  double heading_rad = 0.0;  // not wrapped
  double surge_mps = 0.0;
  double sway_mps = 0.0;
  double yaw_radps = 0.0;
  double port_shaft = 0.0;
  double starboard_shaft = 0.0;
};

/// What drives the boat, held over one step.
struct Drive {
  double port_us = 1500.0;
  double starboard_us = 1500.0;
  double port_share = 1.0;  // of thrust, by battery and weed
  double starboard_share = 1.0;
  BodyForce towline = {};
};

/// Model: rigid body and added mass with their Coriolis terms, drag of two demihulls in the flow
/// each sees (linear, quadratic, cubic), cross-flow drag by strips, a lifting skeg, linear and
/// cubic sway and yaw damping, two thrusters with lagging shafts, air drag by angle of attack.
/// docs/validation/blind-checks.md.
State Rate(const State& state, const Scenario& scenario, const Drive& drive,
           const Surroundings& surroundings);

/// One fourth-order Runge-Kutta step.
State RungeKuttaStep(const State& state, const Scenario& scenario, const Drive& drive,
                     const Surroundings& surroundings, double dt_s);

/// Kinetic energy of boat and added mass without current, joules.
double KineticEnergy(const State& state, const Scenario& scenario);

}  // namespace blind::truth
