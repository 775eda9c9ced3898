#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "coverage/clocks.hpp"
#include "telltale/core/data/samples.hpp"
#include "telltale/core/vessel/vehicle.hpp"

namespace telltale::coverage {

/// Per equation (surge, sway, yaw) the body and propeller coefficients in the order of the
/// propeller parameterization.
struct Boat {
  std::array<double, 9> surge;
  std::array<double, 13> sway;
  std::array<double, 13> yaw;
  double thruster_time_constant_s = 0.0;
  double thrust_bend = 0.0;  ///< share of cubic thrust that no quadratic has
};

/// Its coefficients in the order in which an identification lists them.
std::vector<double> CoefficientsOf(const Boat& boat);

/// A stable 1.2 m catamaran with two thrusters, in SI units.
Boat ReferenceBoat();

/// The disturbances of the boat and the noise of its sensors.
struct SimulatedEnvironment {
  std::array<double, 3> disturbance_sigma{0.03, 0.03, 0.04};  ///< m/s^2, m/s^2, rad/s^2
  double disturbance_time_constant_s = 4.0;
  double position_noise_m = 0.02;
  double heading_noise_deg = 0.3;
  double position_drift_m = 0.0;  ///< AR(1), on top of the white noise
  double position_drift_time_s = 20.0;
  /// Steady accelerations of surge, sway and yaw: coefficients of 1, cos psi and sin psi.
  std::array<std::array<double, 3>, 3> constant_disturbance{};
  Clocks clocks;  ///< nobody steers here
};

struct Mission {
  int segments = 40;
  double segment_s = 40.0;
  double command_share = 1.0;  ///< of the full range of commands
};

/// Random steps for each propeller, segment by segment with gaps of ten seconds between.
/// The boat is integrated at 0.01 s; sensors as in the paper: GNSS 5 Hz, heading 50 Hz, PWM 10 Hz.
Recording Simulate(const Boat& boat, const SimulatedEnvironment& environment,
                   const Mission& mission, std::uint64_t seed);

/// A run of the same boat without sensor noise, against which a prediction is checked.
struct TrueRun {
  std::vector<double> command_times_s;          ///< from zero, held until the next
  std::vector<std::array<double, 2>> commands;  ///< port, starboard
  std::array<double, 3> start;                  ///< u, v, r at time zero
  std::vector<std::array<double, 3>> nu;        ///< after each step of `step_s`
};

/// Simulates the boat for `duration_s`, after it has run for a while and its thrusters have settled
/// on the first command.
TrueRun SimulateTrueRun(const Boat& boat, const SimulatedEnvironment& environment,
                        const Mission& mission, double duration_s, double step_s,
                        std::uint64_t seed);

Vehicle VehicleOf();

}  // namespace telltale::coverage
