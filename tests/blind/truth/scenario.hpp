#pragma once

#include "hull.hpp"

namespace blind::truth {

/// The day: directions are where wind, current and waves go to, radians clockwise from north.
struct Weather {
  double wind_mps = 0.0;
  double wind_towards = 0.0;
  double gust_share = 0.15;  // standard deviation over mean
  double gust_time_s = 8.0;
  double current_mps = 0.0;
  double current_towards = 0.0;
  double current_drift_mps = 0.0;  // standard deviation about that, each of north and east
  double current_drift_s = 120.0;  // how long it lasts
  double wave_force_n = 0.0;       // amplitude of the regular sea of the same energy
  double wave_period_s = 2.0;      // at the peak
  bool is_wind_sea = false;        // of a broad spectrum; else a swell about the peak
  double wave_spread_rad = 0.15;   // standard deviation of the components' directions
  double wave_towards = 0.0;
};

/// A nominal day: light air, hardly a current, ripples.
Weather LightDay(RandomStream rng);

/// All that can be wrong with boat or sensors; as it stands nothing is.
struct Faults {
  double dead_zone_widening_us = 0.0;
  double extra_lag_s = 0.0;
  double command_delay_s = 0.0;
  double port_share = 1.0;
  double starboard_share = 1.0;
  double command_limit = 1.0;     // share of full command
  double misalignment_rad = 0.0;  // of both thrusters, to starboard
  double thrust_share = 1.0;
  double sag = 0.0;  // thrust lost by the end of a usual mission
  double extra_inflow_loss = 0.0;
  double payload_kg = 0.0;
  double payload_x_m = 0.0;
  bool payload_sinks = false;  // and trims the hull
  double fouling = 1.0;
  double crossflow = 1.0;
  double munk = 0.0;  // share by which the Munk moment is larger
  double body_x_n = 0.0;
  double body_y_n = 0.0;
  double body_n_nm = 0.0;

  double heading_bias_rad = 0.0;
  double antenna_forward_m = 0.0;
  double antenna_starboard_m = 0.0;
  double gnss_latency_s = 0.0;
  double hard_iron_forward = 0.0;  // of a magnet in the boat, in horizontal fields of the earth
  double hard_iron_starboard = 0.0;
  double soft_iron = 0.0;      // share by which iron strengthens the field along its axis
  double soft_iron_rad = 0.0;  // that axis, from forward to starboard

  double output_travel_s = 0.0;  // of both outputs, from neutral to full
  bool port_stuck = false;
  bool starboard_stuck = false;
  double stuck_us = 1500.0;  // where

  double shear_mps = 0.0;  // current across a front, on either side of it
  double eddy_mps = 0.0;   // current that turns every few boat lengths
  double wash_force_n = 0.0;
  double heading_drift_rad = 0.0;
  double fix_drift_m = 0.0;
  double tow_kg = 0.0;
  double weed_share = 0.0;  // of the time that one thruster is fouled
  double shoal_drag = 0.0;  // drag gained where it is shallow, as a share
};

struct Scenario {
  Hull hull;
  Weather weather;
  Faults faults;
};

}  // namespace blind::truth
