#include "motion.hpp"

#include <algorithm>
#include <cmath>

#include "thruster.hpp"

namespace blind::truth {
namespace {

struct Flow {  // of the water along the hull, from the boat's motion through it
  double u;
  double v;
  double r;
};

struct Inertia {
  double mass;
  double mass_x_g;
  double yaw;
  double added_surge;
  double added_sway;
  double added_coupling;
  double added_yaw;
};

/// How a payload changes the draught, as a share of it: everywhere, and more at the bow than that.
struct Immersion {
  double sinkage = 0.0;
  double trim = 0.0;
};

Immersion ImmersionOf(const Hull& hull, const Faults& faults) {
  if (!faults.payload_sinks) return {};
  constexpr double kWaterDensity = 1025.0, kDraughtM = 0.12, kDemihullBeamM = 0.17;
  constexpr double kWaterplane = 0.78, kWaterplaneInertia = 0.6;
  const double area = 2.0 * kWaterplane * kDemihullBeamM * hull.length_m;
  const double inertia =
      2.0 * kWaterplaneInertia * kDemihullBeamM * std::pow(hull.length_m, 3) / 12.0;
  const double lever = faults.payload_kg * (faults.payload_x_m - hull.x_g_m);
  return {.sinkage = faults.payload_kg / (kWaterDensity * area * kDraughtM),
          .trim = lever / (kWaterDensity * inertia) * 0.5 * hull.length_m / kDraughtM};
}

Inertia InertiaOf(const Hull& hull, const Faults& faults, double shoal) {
  // Water that cannot pass under the hull is carried along.
  const double carried = 1.0 + 0.3 * shoal;
  const double deeper = std::pow(1.0 + ImmersionOf(hull, faults).sinkage, 1.8);
  return {.mass = hull.mass_kg + faults.payload_kg,
          .mass_x_g = hull.mass_kg * hull.x_g_m + faults.payload_kg * faults.payload_x_m,
          .yaw = hull.inertia_z_kgm2 +
                 faults.payload_kg * (faults.payload_x_m * faults.payload_x_m + 0.01),
          .added_surge = carried * hull.added_surge_kg,
          .added_sway = deeper * carried * hull.added_sway_kg,
          .added_coupling = deeper * carried * hull.added_coupling_kgm,
          .added_yaw = deeper * carried * hull.added_yaw_kgm2};
}

void Apply(BodyForce& sum, double x, double y, double n) {
  sum.x_n += x;
  sum.y_n += y;
  sum.n_nm += n;
}

void AddCoriolis(BodyForce& sum, const Inertia& inertia, double munk, const State& state,
                 const Flow& flow) {
  const double u = state.surge_mps, v = state.sway_mps, r = state.yaw_radps;
  Apply(sum, r * (inertia.mass * v + inertia.mass_x_g * r), -inertia.mass * u * r,
        -inertia.mass_x_g * u * r);
  const double sway_momentum = inertia.added_sway * flow.v + inertia.added_coupling * flow.r;
  const double surge_momentum = inertia.added_surge * flow.u;
  Apply(sum, sway_momentum * flow.r, -surge_momentum * flow.r,
        surge_momentum * flow.v - sway_momentum * flow.u);
  Apply(sum, 0.0, 0.0, -munk * (inertia.added_sway - inertia.added_surge) * flow.u * flow.v);
}

void AddResistance(BodyForce& sum, const Hull& hull, const Faults& faults, double shoal,
                   const Flow& flow) {
  const double deeper = 1.0 + 0.15 * faults.payload_kg / hull.mass_kg;
  const double sinkage = ImmersionOf(hull, faults).sinkage;
  for (const double y : {-0.5 * hull.demihull_spacing_m, 0.5 * hull.demihull_spacing_m}) {
    const double u = flow.u - flow.r * y;
    const double friction = (1.0 + 0.65 * sinkage) * faults.fouling *
                            (hull.surge_linear + hull.surge_quadratic * std::abs(u));
    const double wave_making = (1.0 + 1.5 * sinkage) * hull.surge_cubic * u * u;
    const double drag = 0.5 * deeper * (1.0 + shoal) * (friction + wave_making) * u;
    Apply(sum, -drag, 0.0, drag * y);
  }
}

void AddCrossflow(BodyForce& sum, const Hull& hull, double share, const Immersion& immersion,
                  const Flow& flow) {
  constexpr int kStrips = 10;
  const double width = hull.length_m / kStrips;
  for (int strip = 0; strip < kStrips; ++strip) {
    const double x = (strip + 0.5) * width - 0.5 * hull.length_m;
    const double speed = flow.v + x * flow.r;
    const double leaning = 1.0 + immersion.sinkage +
                           (hull.crossflow_centre + immersion.trim) * 2.0 * x / hull.length_m;
    const double drag = share * hull.crossflow * leaning * width * std::abs(speed) * speed;
    Apply(sum, 0.0, -drag, -drag * x);
  }
}

void AddSkegAndWaveMaking(BodyForce& sum, const Hull& hull, double share, const Flow& flow) {
  const double side_speed = flow.v + hull.skeg_x_m * flow.r;
  const double lift = -hull.skeg_lift * std::abs(flow.u) * side_speed;
  Apply(sum, 0.0, lift, hull.skeg_x_m * lift);
  Apply(sum, 0.0, -share * (hull.sway_linear + hull.sway_cubic * flow.v * flow.v) * flow.v,
        -share * (hull.yaw_linear + hull.yaw_cubic * flow.r * flow.r) * flow.r);
}

void AddThrust(BodyForce& sum, const Scenario& scenario, const Drive& drive, const State& state,
               const Flow& flow) {
  const Hull& hull = scenario.hull;
  const Faults& faults = scenario.faults;
  const double loss = hull.inflow_loss + faults.extra_inflow_loss;
  const auto add = [&](double y, double shaft, double share) {
    const double thrust = hull.thrust_kept * faults.thrust_share * share * ThrustAt(shaft) *
                          InflowShare(loss, shaft, flow.u - flow.r * y);
    const double x_force = thrust * std::cos(faults.misalignment_rad);
    const double y_force = thrust * std::sin(faults.misalignment_rad);
    Apply(sum, x_force, y_force, hull.propeller_x_m * y_force - y * x_force);
  };
  const double half = 0.5 * hull.propeller_separation_m;
  add(-half, state.port_shaft, hull.port_share * faults.port_share * drive.port_share);
  add(half, state.starboard_shaft,
      hull.starboard_share * faults.starboard_share * drive.starboard_share);
}

void AddWind(BodyForce& sum, const Hull& hull, const State& state, const Surroundings& air) {
  constexpr double kAirDensity = 1.225;
  const double c = std::cos(state.heading_rad), s = std::sin(state.heading_rad);
  const double ahead = state.surge_mps - c * air.wind_north_mps - s * air.wind_east_mps;
  const double aside = state.sway_mps + s * air.wind_north_mps - c * air.wind_east_mps;
  const double speed = std::hypot(ahead, aside);
  if (speed == 0.0) return;
  const double ca = ahead / speed, sa = aside / speed;
  const double pressure = 0.5 * kAirDensity * speed * speed;
  const double side = pressure * hull.lateral_area_m2 * 0.9 * sa * (1.0 - 0.15 * ca * ca);
  Apply(sum, -pressure * hull.frontal_area_m2 * 0.75 * ca * (1.0 - 0.22 * sa * sa), -side,
        -side * hull.length_m * hull.windage_lever * (0.3 + ca));
}

double ShaftRate(double pulse_us, double shaft, const Scenario& scenario) {
  const Faults& faults = scenario.faults;
  const double limited =
      kNeutralUs + std::clamp(pulse_us - kNeutralUs, -kFullUs * faults.command_limit,
                              kFullUs * faults.command_limit);
  const double wanted =
      ShaftSpeed(BollardThrust(WithWiderDeadZone(limited, faults.dead_zone_widening_us)));
  return (wanted - shaft) / (scenario.hull.motor_lag_s + faults.extra_lag_s);
}

State Moved(const State& state, const State& rate, double dt_s) {
  return {.north_m = state.north_m + dt_s * rate.north_m,
          .east_m = state.east_m + dt_s * rate.east_m,
          .heading_rad = state.heading_rad + dt_s * rate.heading_rad,
          .surge_mps = state.surge_mps + dt_s * rate.surge_mps,
          .sway_mps = state.sway_mps + dt_s * rate.sway_mps,
          .yaw_radps = state.yaw_radps + dt_s * rate.yaw_radps,
          .port_shaft = state.port_shaft + dt_s * rate.port_shaft,
          .starboard_shaft = state.starboard_shaft + dt_s * rate.starboard_shaft};
}

}  // namespace

State Rate(const State& state, const Scenario& scenario, const Drive& drive,
           const Surroundings& surroundings) {
  const Hull& hull = scenario.hull;
  const Faults& faults = scenario.faults;
  const double c = std::cos(state.heading_rad), s = std::sin(state.heading_rad);
  const double current_u = c * surroundings.current_north_mps + s * surroundings.current_east_mps;
  const double current_v = c * surroundings.current_east_mps - s * surroundings.current_north_mps;
  const double r = state.yaw_radps;
  const Flow flow{state.surge_mps - current_u, state.sway_mps - current_v, r};
  const Inertia inertia = InertiaOf(hull, faults, surroundings.shoal);

  BodyForce sum{faults.body_x_n, faults.body_y_n, faults.body_n_nm};
  Apply(sum, surroundings.waves.x_n, surroundings.waves.y_n, surroundings.waves.n_nm);
  Apply(sum, drive.towline.x_n, drive.towline.y_n, drive.towline.n_nm);
  AddCoriolis(sum, inertia, faults.munk, state, flow);
  AddResistance(sum, hull, faults, surroundings.shoal, flow);
  const double across = 1.0 + surroundings.shoal;
  AddCrossflow(sum, hull, faults.crossflow * across, ImmersionOf(hull, faults), flow);
  AddSkegAndWaveMaking(sum, hull, across, flow);
  AddThrust(sum, scenario, drive, state, flow);
  AddWind(sum, hull, state, surroundings);
  // The current turns as seen from the boat, and the added mass with it.
  Apply(sum, inertia.added_surge * r * current_v, -inertia.added_sway * r * current_u,
        -inertia.added_coupling * r * current_u);

  const double m11 = inertia.mass + inertia.added_surge;
  const double m22 = inertia.mass + inertia.added_sway;
  const double m23 = inertia.mass_x_g + inertia.added_coupling;
  const double m33 = inertia.yaw + inertia.added_yaw;
  const double determinant = m22 * m33 - m23 * m23;
  return {.north_m = c * state.surge_mps - s * state.sway_mps,
          .east_m = s * state.surge_mps + c * state.sway_mps,
          .heading_rad = r,
          .surge_mps = sum.x_n / m11,
          .sway_mps = (m33 * sum.y_n - m23 * sum.n_nm) / determinant,
          .yaw_radps = (m22 * sum.n_nm - m23 * sum.y_n) / determinant,
          .port_shaft = ShaftRate(drive.port_us, state.port_shaft, scenario),
          .starboard_shaft = ShaftRate(drive.starboard_us, state.starboard_shaft, scenario)};
}

State RungeKuttaStep(const State& state, const Scenario& scenario, const Drive& drive,
                     const Surroundings& surroundings, double dt_s) {
  const auto rate = [&](const State& at) { return Rate(at, scenario, drive, surroundings); };
  const State k1 = rate(state);
  const State k2 = rate(Moved(state, k1, 0.5 * dt_s));
  const State k3 = rate(Moved(state, k2, 0.5 * dt_s));
  const State k4 = rate(Moved(state, k3, dt_s));
  return Moved(Moved(Moved(Moved(state, k1, dt_s / 6.0), k2, dt_s / 3.0), k3, dt_s / 3.0), k4,
               dt_s / 6.0);
}

double KineticEnergy(const State& state, const Scenario& scenario) {
  const Inertia inertia = InertiaOf(scenario.hull, scenario.faults, 0.0);
  const double u = state.surge_mps, v = state.sway_mps, r = state.yaw_radps;
  return 0.5 * ((inertia.mass + inertia.added_surge) * u * u +
                (inertia.mass + inertia.added_sway) * v * v +
                2.0 * (inertia.mass_x_g + inertia.added_coupling) * v * r +
                (inertia.yaw + inertia.added_yaw) * r * r);
}

}  // namespace blind::truth
