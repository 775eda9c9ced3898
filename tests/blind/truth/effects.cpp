#include "effects.hpp"

#include <cmath>
#include <stdexcept>

#include "degree.hpp"

namespace blind::truth {
namespace {

using Parameters = std::vector<Parameter>;

double Degrees(double radians) {
  return radians / kDegree;
}

Parameters Wind(Scenario& scenario, double size, double, RandomStream& rng) {
  Weather& day = scenario.weather;
  day.wind_mps = 5.0 * std::sqrt(size);  // force, not speed, goes with the size
  day.wind_towards = rng.Angle();
  day.gust_share = rng.Uniform(0.1, 0.2);
  day.gust_time_s = rng.LogUniform(3.0, 20.0);
  return {{"speed", day.wind_mps, "m/s"},
          {"towards", Degrees(day.wind_towards), "deg"},
          {"gusts over mean", day.gust_share, ""},
          {"gusts last", day.gust_time_s, "s"}};
}

Parameters Current(Scenario& scenario, double size, double, RandomStream& rng) {
  Weather& day = scenario.weather;
  day.current_mps = 0.2 * size;
  day.current_towards = rng.Angle();
  day.current_drift_mps = rng.Uniform(0.1, 0.3) * day.current_mps;
  day.current_drift_s = rng.LogUniform(60.0, 300.0);
  return {{"speed", day.current_mps, "m/s"},
          {"towards", Degrees(day.current_towards), "deg"},
          {"drift", day.current_drift_mps, "m/s"},
          {"drift lasts", day.current_drift_s, "s"}};
}

Parameters Waves(Scenario& scenario, double size, double, RandomStream& rng) {
  constexpr double kLongCrested = 0.05, kShortCrested = 0.5;
  Weather& day = scenario.weather;
  day.wave_force_n = 10.0 * size;
  day.wave_period_s = 1.0 / rng.LogUniform(0.15, 0.8);
  day.wave_towards = rng.Angle();
  day.is_wind_sea = true;
  day.wave_spread_rad = rng.Sign() > 0.0 ? kLongCrested : kShortCrested;
  return {{"force", day.wave_force_n, "N"},
          {"peak period", day.wave_period_s, "s"},
          {"towards", Degrees(day.wave_towards), "deg"},
          {"spread", Degrees(day.wave_spread_rad), "deg"}};
}

Parameters BodyBias(Scenario& scenario, double size, double sign, RandomStream& rng) {
  Faults& faults = scenario.faults;
  const double direction = rng.Uniform(-75.0, 75.0) * kDegree;  // the sign turns it round
  faults.body_x_n = sign * 2.0 * size * std::cos(direction);
  faults.body_y_n = sign * 2.0 * size * std::sin(direction);
  faults.body_n_nm = size * rng.Sign() * rng.Uniform(0.3, 0.7);
  return {{"X", faults.body_x_n, "N"}, {"Y", faults.body_y_n, "N"}, {"N", faults.body_n_nm, "N m"}};
}

Parameters DeadZone(Scenario& scenario, double size, double, RandomStream&) {
  scenario.faults.dead_zone_widening_us = 24.0 * size;
  return {{"widening", scenario.faults.dead_zone_widening_us, "us"}};
}

Parameters Lag(Scenario& scenario, double size, double, RandomStream&) {
  scenario.faults.extra_lag_s = 0.25 * size;
  return {{"added time constant", scenario.faults.extra_lag_s, "s"}};
}

Parameters Delay(Scenario& scenario, double size, double, RandomStream&) {
  scenario.faults.command_delay_s = 0.2 * size;
  return {{"delay", scenario.faults.command_delay_s, "s"}};
}

Parameters Imbalance(Scenario& scenario, double size, double sign, RandomStream&) {
  const double lost = 0.2 * size;
  (sign > 0.0 ? scenario.faults.port_share : scenario.faults.starboard_share) = 1.0 - lost;
  return {{sign > 0.0 ? "port lost" : "starboard lost", lost, ""}};
}

Parameters Saturation(Scenario& scenario, double size, double, RandomStream&) {
  scenario.faults.command_limit = 1.0 - 0.25 * size;
  return {{"limit", scenario.faults.command_limit, ""}};
}

Parameters Misalignment(Scenario& scenario, double size, double sign, RandomStream&) {
  scenario.faults.misalignment_rad = sign * 2.0 * size * kDegree;
  return {{"angle", sign * 2.0 * size, "deg"}};
}

Parameters Gain(Scenario& scenario, double size, double sign, RandomStream&) {
  scenario.faults.thrust_share = 1.0 - sign * 0.1 * size;
  return {{"lost", sign * 0.1 * size, ""}};
}

Parameters Sag(Scenario& scenario, double size, double, RandomStream&) {
  scenario.faults.sag = 0.14 * size;
  return {{"lost at the end", scenario.faults.sag, ""}};
}

Parameters InflowLoss(Scenario& scenario, double size, double, RandomStream&) {
  scenario.faults.extra_inflow_loss = 0.17 * size;
  return {{"lost at 1.8 m/s", scenario.faults.extra_inflow_loss, ""}};
}

Parameters Payload(Scenario& scenario, double size, double, RandomStream& rng) {
  scenario.faults.payload_kg = 0.2 * size * scenario.hull.mass_kg;
  scenario.faults.payload_x_m = rng.Sign() * rng.Uniform(0.05, 0.3);
  return {{"mass", scenario.faults.payload_kg, "kg"}, {"x", scenario.faults.payload_x_m, "m"}};
}

Parameters TrimSinkage(Scenario& scenario, double size, double sign, RandomStream& rng) {
  scenario.faults.payload_sinks = true;
  return Payload(scenario, size, sign, rng);
}

Parameters Fouling(Scenario& scenario, double size, double, RandomStream&) {
  scenario.faults.fouling = 1.0 + 0.25 * size;
  return {{"friction times", scenario.faults.fouling, ""}};
}

Parameters Crossflow(Scenario& scenario, double size, double, RandomStream&) {
  scenario.faults.crossflow = 1.0 + 0.5 * size;
  return {{"drag times", scenario.faults.crossflow, ""}};
}

Parameters Munk(Scenario& scenario, double size, double sign, RandomStream&) {
  scenario.faults.munk = sign * 0.5 * size;
  return {{"moment gained", scenario.faults.munk, ""}};
}

Parameters HeadingBias(Scenario& scenario, double size, double sign, RandomStream&) {
  scenario.faults.heading_bias_rad = sign * 3.0 * size * kDegree;
  return {{"bias", sign * 3.0 * size, "deg"}};
}

Parameters LeverArm(Scenario& scenario, double size, double sign, RandomStream& rng) {
  Faults& faults = scenario.faults;
  const double direction = rng.Uniform(-60.0, 60.0) * kDegree;  // fore or aft rather than abeam
  faults.antenna_forward_m = sign * 0.3 * size * std::cos(direction);
  faults.antenna_starboard_m = sign * 0.3 * size * std::sin(direction);
  return {{"forward", faults.antenna_forward_m, "m"},
          {"starboard", faults.antenna_starboard_m, "m"}};
}

Parameters Latency(Scenario& scenario, double size, double, RandomStream&) {
  scenario.faults.gnss_latency_s = 0.2 * size;
  return {{"latency", scenario.faults.gnss_latency_s, "s"}};
}

Parameters Deviation(Scenario& scenario, double size, double, RandomStream& rng) {
  Faults& faults = scenario.faults;
  const double towards = rng.Angle();
  faults.hard_iron_forward = 0.07 * size * std::cos(towards);
  faults.hard_iron_starboard = 0.07 * size * std::sin(towards);
  faults.soft_iron = 0.08 * size;
  faults.soft_iron_rad = rng.Angle();
  return {{"hard iron forward", faults.hard_iron_forward, ""},
          {"hard iron starboard", faults.hard_iron_starboard, ""},
          {"soft iron", faults.soft_iron, ""},
          {"soft iron towards", Degrees(faults.soft_iron_rad), "deg"}};
}

Parameters Slew(Scenario& scenario, double size, double, RandomStream&) {
  scenario.faults.output_travel_s = 0.6 * size;
  return {{"travel", scenario.faults.output_travel_s, "s"}};
}

Parameters Stuck(Scenario& scenario, double size, double sign, RandomStream& rng) {
  Faults& faults = scenario.faults;
  (sign > 0.0 ? faults.port_stuck : faults.starboard_stuck) = true;
  faults.stuck_us = 1500.0 + rng.Sign() * 80.0 * size;
  return {{sign > 0.0 ? "port stuck at" : "starboard stuck at", faults.stuck_us, "us"}};
}

Parameters Shear(Scenario& scenario, double size, double, RandomStream&) {
  scenario.faults.shear_mps = 0.25 * size;
  return {{"amplitude", scenario.faults.shear_mps, "m/s"}};
}

Parameters Wash(Scenario& scenario, double size, double, RandomStream&) {
  scenario.faults.wash_force_n = 40.0 * size;
  return {{"force", scenario.faults.wash_force_n, "N"}};
}

Parameters Eddies(Scenario& scenario, double size, double, RandomStream&) {
  scenario.faults.eddy_mps = 0.25 * size;
  return {{"amplitude", scenario.faults.eddy_mps, "m/s"}};
}

Parameters FixDrift(Scenario& scenario, double size, double, RandomStream&) {
  scenario.faults.fix_drift_m = 0.4 * size;
  return {{"standard deviation", scenario.faults.fix_drift_m, "m"}};
}

Parameters HeadingDrift(Scenario& scenario, double size, double, RandomStream&) {
  scenario.faults.heading_drift_rad = 4.0 * size * kDegree;
  return {{"standard deviation", 4.0 * size, "deg"}};
}

Parameters TowedObject(Scenario& scenario, double size, double, RandomStream&) {
  scenario.faults.tow_kg = 12.0 * size;
  return {{"mass", scenario.faults.tow_kg, "kg"}};
}

Parameters Weed(Scenario& scenario, double size, double, RandomStream&) {
  scenario.faults.weed_share = 0.15 * size;
  return {{"share of time", scenario.faults.weed_share, ""}};
}

Parameters Shallows(Scenario& scenario, double size, double, RandomStream&) {
  scenario.faults.shoal_drag = 0.6 * size;
  return {{"drag gained", scenario.faults.shoal_drag, ""}};
}

}  // namespace

const std::vector<Effect>& Effects() {
  static const std::vector<Effect> effects{
      {"wind", false, true, Wind},
      {"current", false, true, Current},
      {"current_shear", false, true, Shear},
      {"waves", false, true, Waves},
      {"body_bias", true, true, BodyBias},
      {"thruster_dead_zone", false, true, DeadZone},
      {"thruster_lag", false, true, Lag},
      {"thruster_delay", false, true, Delay},
      {"thruster_imbalance", true, true, Imbalance},
      {"thruster_saturation", false, true, Saturation},
      {"output_slew", false, true, Slew},
      {"output_stuck", true, true, Stuck},
      {"thruster_misalignment", true, true, Misalignment},
      {"thrust_gain", true, true, Gain},
      {"thrust_sag", false, true, Sag},
      {"thrust_inflow_loss", false, true, InflowLoss},
      {"intermittent_thrust_loss", false, true, Weed},
      {"payload", false, true, Payload},
      {"trim_sinkage", false, true, TrimSinkage},
      {"hull_fouling", false, true, Fouling},
      {"crossflow_drag", false, true, Crossflow},
      {"added_mass_coupling", true, true, Munk},
      {"heading_bias", true, true, HeadingBias},
      {"magnetic_deviation", false, true, Deviation},
      {"antenna_lever_arm", true, true, LeverArm},
      {"gnss_latency", false, true, Latency},
      {"current_eddies", false, false, Eddies},
      {"ship_wash", false, false, Wash},
      {"compass_wander", false, false, HeadingDrift},
      {"towed_object", false, false, TowedObject},
      {"gnss_drift", false, false, FixDrift},
      {"shallow_water", false, false, Shallows},
  };
  return effects;
}

const Effect& EffectNamed(const std::string& name) {
  std::string known;
  for (const Effect& effect : Effects()) {
    if (effect.name == name) return effect;
    known += (known.empty() ? "" : ", ") + effect.name;
  }
  throw std::invalid_argument("no effect " + name + "; there are " + known);
}

}  // namespace blind::truth
