#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "random_stream.hpp"

namespace blind::truth {

/// How much later than it happened each channel is stamped, seconds.
struct Clocks {
  double commands_s = 0.0;
  double fixes_s = 0.0;
  double headings_s = 0.0;
};

/// A 1.3 m catamaran with two T200. Body axes: x forward, y to starboard, z down; SI throughout.
struct Hull {
  std::string name;
  double length_m = 1.3;
  double demihull_spacing_m = 0.7;  // between the centre planes
  double mass_kg = 35.0;
  double x_g_m = 0.0;
  double inertia_z_kgm2 = 5.5;  // about the body origin
  double added_surge_kg = 2.5;
  double added_sway_kg = 26.0;
  double added_coupling_kgm = 0.0;  // sway-yaw
  double added_yaw_kgm2 = 4.0;

  double surge_linear = 7.0;      // N s/m
  double surge_quadratic = 18.0;  // N s^2/m^2
  double surge_cubic = 1.5;       // N s^3/m^3
  double sway_linear = 25.0;
  double sway_cubic = 15.0;
  double yaw_linear = 16.0;  // N m s
  double yaw_cubic = 3.0;
  double crossflow = 95.0;        // N s^2/m^3, drag per metre of both demihulls
  double crossflow_centre = 0.0;  // drag per metre leans to the bow by this share
  double skeg_lift = 30.0;        // N s^2/m^2
  double skeg_x_m = -0.45;

  double propeller_separation_m = 0.7;
  double propeller_x_m = -0.5;
  double thrust_kept = 0.9;  // by hull and mounting
  double port_share = 1.0;
  double starboard_share = 1.0;
  double motor_lag_s = 0.08;
  double inflow_loss = 0.08;

  double frontal_area_m2 = 0.18;
  double lateral_area_m2 = 0.38;
  double windage_lever = 0.1;  // C_N over C_Y at its largest
  double antenna_forward_m = 0.0;
  double antenna_starboard_m = 0.0;
  Clocks clocks;  // of every day alike; a day has a little of its own besides
};

enum class Set { kDevelopment, kHeldOut };

/// The boats of a set; no two sets share one.
std::vector<Hull> Fleet(Set set, std::uint64_t seed);

/// The vehicle file an operator would write for the boat: what the boat is, as far as operators
/// know.
std::string VehicleFile(const Hull& hull);

}  // namespace blind::truth
