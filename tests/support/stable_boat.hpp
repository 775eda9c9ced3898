#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "telltale/core/data/samples.hpp"
#include "telltale/core/simulation/manoeuvres.hpp"
#include "telltale/core/simulation/sensors.hpp"
#include "telltale/core/simulation/simulator.hpp"
#include "telltale/core/vessel/vehicle.hpp"
#include "telltale/core/vessel/vessel_model.hpp"

namespace telltale::testing {

/// A made-up catamaran of 1.2 m, stable on every course, in SI units, every coefficient of the
/// propeller parameterization at work. Its thrusters lag if a time constant is given.
inline VesselModel StableBoat(std::optional<double> time_constant_s = std::nullopt) {
  VesselModel model;
  model.structure = time_constant_s ? Structure::kFirstOrderDynamic : Structure::kStaticQuadratic;
  model.thruster_time_constant_s = time_constant_s;
  model.parameterization = Parameterization::kPropeller;
  model.discretisation = Discretisation::kContinuous;
  model.sampling_period_s = 0.2;
  model.theta = {Eigen::VectorXd(9), Eigen::VectorXd(13), Eigen::VectorXd(13)};
  model.theta[0] << -0.35, 0.9, 0.05, -0.25, 0.01, 0.45, 0.25, -0.3, 0.2;
  model.theta[1] << -0.8, -0.2, 0.1, 0.05, -0.2, -0.6, -0.6, 0.05, 0.005, 0.02, 0.03, -0.02, 0.02;
  model.theta[2] << 0.05, 0.02, -0.1, -0.9, -0.15, -0.35, -0.1, -0.8, 0.005, 0.9, 0.5, -0.6, 0.4;
  return model;
}

inline Vehicle StableBoatVehicle() {
  Vehicle vehicle;
  vehicle.vehicle_id = "stable";
  vehicle.propeller_separation_m = 0.7;
  vehicle.gnss_antenna = {-0.2, 0.1};
  return vehicle;
}

/// Random steps ahead, and one side astern now and then, in pieces of `piece_s`: ahead, port
/// astern, ahead, starboard astern, and so on, or from the piece `first` of these on.
inline std::vector<TimedCommand> VariedCommands(double duration_s, std::uint64_t seed,
                                                double piece_s = 20.0, std::uint64_t first = 0) {
  const CommandRange ahead{{0.1, 0.1}, {1.0, 1.0}};
  const CommandRange port_astern{{-0.7, 0.1}, {-0.1, 1.0}};
  const CommandRange starboard_astern{{0.1, -0.7}, {1.0, -0.1}};
  std::vector<Manoeuvre> manoeuvres;
  for (std::uint64_t piece = 0; static_cast<double>(piece) * piece_s < duration_s; ++piece) {
    const CommandRange& range = (first + piece) % 4 == 1   ? port_astern
                                : (first + piece) % 4 == 3 ? starboard_astern
                                                           : ahead;
    manoeuvres.push_back(RandomSteps(range, 1.4, 5.0, piece_s, seed + piece));
  }
  return Schedule(manoeuvres, 0.0);
}

/// Where the boat goes under commands in pieces of 10 s, at steps of 0.02 s.
inline std::vector<TimedState> StableBoatTrack(const VesselModel& model, double duration_s,
                                               std::uint64_t seed) {
  constexpr std::uint64_t kAheadThenStarboardAstern = 2;
  const auto commands = VariedCommands(duration_s, seed, 10.0, kAheadThenStarboardAstern);
  VesselState start;
  start.nu.u = 0.5;
  start.thrust = model.SteadyThrust(commands.front().delta);
  return Simulate(model, start, commands, duration_s, 0.02);
}

/// The boat simulated for `duration_s` at steps of 0.02 s and measured.
inline Recording SimulateStableBoat(const VesselModel& model, double duration_s,
                                    const SensorOptions& sensors, std::uint64_t seed) {
  VesselState start;
  start.nu.u = 0.5;
  return Measure(Simulate(model, start, VariedCommands(duration_s, seed), duration_s, 0.02),
                 StableBoatVehicle(), sensors);
}

/// `noise_scale` times 0.02 m and 0.3 degrees.
inline SensorOptions NoisySensors(double noise_scale, std::uint64_t seed) {
  SensorOptions sensors;
  sensors.position_noise_m = 0.02 * noise_scale;
  sensors.heading_noise_deg = 0.3 * noise_scale;
  sensors.seed = seed;
  return sensors;
}

inline SensorOptions NoNoise() {
  SensorOptions sensors;
  sensors.position_noise_m = 0.0;
  sensors.heading_noise_deg = 0.0;
  return sensors;
}

}  // namespace telltale::testing
