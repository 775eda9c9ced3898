#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "telltale/core/data/preparation.hpp"
#include "telltale/core/simulation/manoeuvres.hpp"
#include "telltale/core/simulation/sensors.hpp"
#include "telltale/core/simulation/simulator.hpp"
#include "telltale/core/vessel/vessel_model.hpp"

namespace telltale::testing {

/// A stable catamaran of 1.2 m, continuous, every coefficient of the propeller parameterization at
/// work; thrusters lag if a time constant is given.
inline VesselModel Catamaran(std::optional<double> time_constant_s = std::nullopt) {
  VesselModel model;
  model.structure = time_constant_s ? Structure::kFirstOrderDynamic : Structure::kStaticQuadratic;
  model.parameterization = Parameterization::kPropeller;
  model.discretisation = Discretisation::kContinuous;
  model.thruster_time_constant_s = time_constant_s;
  model.theta[0].resize(9);
  model.theta[0] << -0.35, 0.9, 0.05, -0.25, 0.01, 0.45, 0.25, -0.3, 0.2;
  model.theta[1].resize(13);
  model.theta[1] << -0.8, -0.2, 0.1, 0.05, -0.2, -0.6, -0.6, 0.05, 0.005, 0.02, 0.03, -0.02, 0.02;
  model.theta[2].resize(13);
  model.theta[2] << 0.05, 0.02, -0.1, -0.9, -0.15, -0.35, -0.1, -0.8, 0.005, 0.9, 0.5, -0.6, 0.4;
  return model;
}

inline Vehicle CatamaranVehicle() {
  Vehicle vehicle;
  vehicle.vehicle_id = "catamaran";
  vehicle.propeller_separation_m = 0.7;
  vehicle.gnss_antenna = {-0.2, 0.1};
  return vehicle;
}

/// Where the catamaran goes under random steps in FF, FR and RF; at 0.02 s.
inline std::vector<TimedState> CatamaranTrack(const VesselModel& model, double duration_s,
                                              std::uint64_t seed) {
  constexpr double kPartS = 10.0;
  constexpr CommandRange kAhead = {{0.1, 0.1}, {1.0, 1.0}};
  constexpr CommandRange kToStarboard = {{0.1, -0.7}, {1.0, -0.1}};
  constexpr CommandRange kToPort = {{-0.7, 0.1}, {-0.1, 1.0}};
  std::vector<Manoeuvre> manoeuvres;
  for (std::uint64_t part = 0; static_cast<double>(part) * kPartS < duration_s; ++part) {
    const auto& range = part % 4 == 1 ? kToStarboard : part % 4 == 3 ? kToPort : kAhead;
    manoeuvres.push_back(RandomSteps(range, 1.4, 5.0, kPartS, seed + part));
  }
  VesselState start;
  start.nu.u = 0.5;
  const auto commands = Schedule(manoeuvres, 0.0);
  start.thrust = model.SteadyThrust(commands.front().delta);
  return Simulate(model, start, commands, duration_s, 0.02);
}

inline SensorOptions CatamaranSensors(double noise_scale, std::uint64_t seed) {
  SensorOptions sensors;
  sensors.position_noise_m = 0.02 * noise_scale;
  sensors.heading_noise_deg = 0.3 * noise_scale;
  sensors.seed = seed;
  return sensors;
}

}  // namespace telltale::testing
