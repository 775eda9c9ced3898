#include "coverage/independent_simulator.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "telltale/core/base/degrees.hpp"
#include "telltale/core/base/random.hpp"
#include "telltale/core/data/north_east_frame.hpp"

namespace telltale::coverage {
namespace {

constexpr double kStepS = 0.01;
constexpr double kGapS = 10.0;
constexpr double kCommandPeriodS = 0.1;
constexpr double kBurnInS = 5.0;  // before the recorder starts

struct State {
  double x = 0.0, y = 0.0, psi = 0.0, u = 0.0, v = 0.0, r = 0.0;
};

State operator+(const State& a, const State& b) {
  return {a.x + b.x, a.y + b.y, a.psi + b.psi, a.u + b.u, a.v + b.v, a.r + b.r};
}
State operator*(double k, const State& a) {
  return {k * a.x, k * a.y, k * a.psi, k * a.u, k * a.v, k * a.r};
}

/// Terms delta^2 and delta, forward and reverse, of one propeller as it has come to turn.
struct PropellerTerms {
  std::array<double, 4> value{};
};

PropellerTerms TermsOf(double delta, double bend) {
  PropellerTerms terms;
  const std::size_t first = delta >= 0.0 ? 0 : 2;
  // The bend pulls the quadratic down at middling commands and leaves its ends.
  const double square = delta * delta * (1.0 - bend + bend * std::abs(delta));
  terms.value[first] = square;
  terms.value[first + 1] = delta;
  return terms;
}

struct Thrusters {
  PropellerTerms port, starboard;

  void Follow(const PropellerTerms& port_steady, const PropellerTerms& starboard_steady,
              double share) {
    for (std::size_t i = 0; i < 4; ++i) {
      port.value[i] += share * (port_steady.value[i] - port.value[i]);
      starboard.value[i] += share * (starboard_steady.value[i] - starboard.value[i]);
    }
  }
};

State Slope(const Boat& boat, const State& s, const Thrusters& thrust,
            const std::array<double, 3>& d) {
  const double au = std::abs(s.u), av = std::abs(s.v), ar = std::abs(s.r);
  const auto& a = boat.surge;
  const auto& b = boat.sway;
  const auto& c = boat.yaw;
  State dot;
  dot.u = a[0] * s.u * au + a[1] * s.v * s.r + a[2] * s.r * s.r + a[3] * s.u + a[4] + d[0];
  const std::array<double, 9> body = {s.v * av,  s.v * ar, s.r * av, s.r * ar, s.u * s.v,
                                      s.u * s.r, s.v,      s.r,      1.0};
  dot.v = d[1];
  dot.r = d[2];
  for (std::size_t i = 0; i < 9; ++i) {
    dot.v += b[i] * body[i];
    dot.r += c[i] * body[i];
  }
  for (std::size_t i = 0; i < 4; ++i) {
    const double port = thrust.port.value[i], starboard = thrust.starboard.value[i];
    dot.u += a[5 + i] * (port + starboard);
    dot.v += b[9 + i] * (port - starboard);
    dot.r += c[9 + i] * (port - starboard);
  }
  dot.x = std::cos(s.psi) * s.u - std::sin(s.psi) * s.v;
  dot.y = std::sin(s.psi) * s.u + std::cos(s.psi) * s.v;
  dot.psi = s.r;
  return dot;
}

class Gaussian {
 public:
  Gaussian(std::uint64_t seed, std::uint64_t stream)
      : engine_(RandomEngine::Stream(seed, stream)) {}
  double operator()() { return normal_(engine_); }

 private:
  RandomEngine engine_;
  std::normal_distribution<double> normal_;
};

/// Stationary first-order Gauss-Markov noise.
class FirstOrderNoise {
 public:
  FirstOrderNoise(double sigma, double time_constant_s, double step_s, std::uint64_t seed,
                  std::uint64_t stream)
      : gaussian_(seed, stream),
        decay_(std::exp(-step_s / time_constant_s)),
        innovation_sd_(sigma * std::sqrt(1.0 - decay_ * decay_)),
        value_(sigma * gaussian_()) {}
  double Next() { return value_ = decay_ * value_ + innovation_sd_ * gaussian_(); }

 private:
  Gaussian gaussian_;
  double decay_, innovation_sd_, value_;
};

class Commands {
 public:
  Commands(std::uint64_t seed, double share, double step_s = kCommandPeriodS)
      : engine_(RandomEngine::Stream(seed, 100)), share_(share), step_s_(step_s) {}

  /// New commands and how long they are held.
  double Draw(double& port, double& starboard) {
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    const double kind = unit(engine_);
    const auto ahead = [&] { return share_ * (0.1 + 0.9 * unit(engine_)); };
    const auto astern = [&] { return -share_ * (0.1 + 0.6 * unit(engine_)); };
    port = kind < 0.8 ? ahead() : astern();
    starboard = kind < 0.6 || kind >= 0.8 ? ahead() : astern();
    port = std::round(400.0 * port) / 400.0;
    starboard = std::round(400.0 * starboard) / 400.0;
    return step_s_ * std::round((1.5 + 4.5 * unit(engine_)) / step_s_);
  }

 private:
  RandomEngine engine_;
  double share_;
  double step_s_;  ///< they change at multiples of it
};

}  // namespace

std::vector<double> CoefficientsOf(const Boat& boat) {
  std::vector<double> all(boat.surge.begin(), boat.surge.end());
  all.insert(all.end(), boat.sway.begin(), boat.sway.end());
  all.insert(all.end(), boat.yaw.begin(), boat.yaw.end());
  return all;
}

Boat ReferenceBoat() {
  return {{-0.35, 0.9, 0.05, -0.25, 0.01, 0.45, 0.25, -0.3, 0.2},
          {-0.8, -0.2, 0.1, 0.05, -0.2, -0.6, -0.6, 0.05, 0.005, 0.02, 0.03, -0.02, 0.02},
          {0.05, 0.02, -0.1, -0.9, -0.15, -0.35, -0.1, -0.8, 0.005, 0.9, 0.5, -0.6, 0.4},
          0.0,
          0.0};
}

Vehicle VehicleOf() {
  Vehicle vehicle;
  vehicle.vehicle_id = "reference";
  vehicle.propeller_separation_m = 0.7;
  vehicle.gnss_antenna = {-0.2, 0.1};
  return vehicle;
}

namespace {

/// The state of a boat, of its thrusters and of its disturbance.
class BoatState {
 public:
  BoatState(const Boat& boat, const SimulatedEnvironment& environment, std::uint64_t seed)
      : boat_(boat),
        constant_disturbance_(environment.constant_disturbance),
        half_step_share_(boat.thruster_time_constant_s > 0.0
                             ? 1.0 - std::exp(-kStepS / 2.0 / boat.thruster_time_constant_s)
                             : 1.0),
        disturbance_{Axis(environment, 0, seed), Axis(environment, 1, seed),
                     Axis(environment, 2, seed)} {}

  void Restart(double psi) {
    state_ = {};
    state_.u = 0.5;
    state_.psi = psi;
    thrust_ = {};
  }

  /// One step of 0.01 s under these commands.
  void Step(double port, double starboard) {
    // Each step is driven by the thrust at its middle.
    Follow(port, starboard);
    const std::array<double, 3> d = {disturbance_[0].Next() + ConstantDisturbance(0),
                                     disturbance_[1].Next() + ConstantDisturbance(1),
                                     disturbance_[2].Next() + ConstantDisturbance(2)};
    const State k1 = Slope(boat_, state_, thrust_, d);
    const State k2 = Slope(boat_, state_ + (kStepS / 2) * k1, thrust_, d);
    const State k3 = Slope(boat_, state_ + (kStepS / 2) * k2, thrust_, d);
    const State k4 = Slope(boat_, state_ + kStepS * k3, thrust_, d);
    state_ = state_ + (kStepS / 6) * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
    Follow(port, starboard);
  }

  const State& Now() const { return state_; }

 private:
  static FirstOrderNoise Axis(const SimulatedEnvironment& environment, std::size_t axis,
                              std::uint64_t seed) {
    return {environment.disturbance_sigma[axis], environment.disturbance_time_constant_s, kStepS,
            seed, 7 + axis};
  }

  void Follow(double port, double starboard) {
    thrust_.Follow(TermsOf(port, boat_.thrust_bend), TermsOf(starboard, boat_.thrust_bend),
                   half_step_share_);
  }

  double ConstantDisturbance(std::size_t axis) const {
    const std::array<double, 3>& terms = constant_disturbance_[axis];
    return terms[0] + terms[1] * std::cos(state_.psi) + terms[2] * std::sin(state_.psi);
  }

  const Boat& boat_;
  std::array<std::array<double, 3>, 3> constant_disturbance_;
  double half_step_share_;
  State state_;
  Thrusters thrust_;
  std::array<FirstOrderNoise, 3> disturbance_;
};

/// GNSS, heading and commands as a recorder would get them.
class Sensors {
 public:
  Sensors(const SimulatedEnvironment& environment, std::uint64_t seed)
      : environment_(environment),
        frame_({37.4205, -5.9944}),
        north_(seed, 1),
        east_(seed, 2),
        heading_(seed, 3),
        stamp_(seed, 10),
        delay_(RandomEngine::Stream(seed, 11)),
        slow_north_(environment.position_drift_m, environment.position_drift_time_s, 0.2, seed, 5),
        slow_east_(environment.position_drift_m, environment.position_drift_time_s, 0.2, seed, 6) {}

  GnssFix Fix(double time_s, const State& state) {
    const double c = std::cos(state.psi);
    const double s = std::sin(state.psi);
    const LeverArm arm = VehicleOf().gnss_antenna;
    const double north = state.x + c * arm.forward_m - s * arm.starboard_m +
                         environment_.position_noise_m * north_() + slow_north_.Next();
    const double east = state.y + s * arm.forward_m + c * arm.starboard_m +
                        environment_.position_noise_m * east_() + slow_east_.Next();
    const GeographicPosition fix = frame_.Inverse({north, east});
    const Clocks& clocks = environment_.clocks;
    std::uniform_real_distribution<double> delay_s(
        clocks.least_fix_delay_s, std::nextafter(clocks.greatest_fix_delay_s, 1.0));
    return {Stamp(time_s + delay_s(delay_)), fix.latitude_deg, fix.longitude_deg};
  }

  HeadingSample Heading(double time_s, const State& state) {
    const double deg = state.psi * kDegreesPerRadian + environment_.heading_noise_deg * heading_();
    return {Stamp(time_s), Wrap360(deg)};
  }

  double CommandStamp(double time_s) { return Stamp(time_s - environment_.clocks.command_delay_s); }

 private:
  double Stamp(double time_s) { return time_s + environment_.clocks.jitter_s * stamp_(); }

  SimulatedEnvironment environment_;
  NorthEastFrame frame_;
  Gaussian north_;
  Gaussian east_;
  Gaussian heading_;
  Gaussian stamp_;
  RandomEngine delay_;
  FirstOrderNoise slow_north_;
  FirstOrderNoise slow_east_;
};

}  // namespace

Recording Simulate(const Boat& boat, const SimulatedEnvironment& environment,
                   const Mission& mission, std::uint64_t seed) {
  const Vehicle vehicle = VehicleOf();
  Recording recording;
  const Clocks& clocks = environment.clocks;
  Commands commands(seed, mission.command_share, clocks.sampled ? kStepS : kCommandPeriodS);
  const long command_steps = std::lround(clocks.command_period_s / kStepS);
  Gaussian course(seed, 4);
  BoatState boat_state(boat, environment, seed);
  Sensors sensors(environment, seed);
  const long steps = std::lround(mission.segment_s / kStepS);
  double origin_s = 1000.0;
  for (int segment = 0; segment < mission.segments; ++segment) {
    boat_state.Restart(2.0 * std::numbers::pi * course());
    double port = 0.0;
    double starboard = 0.0;
    double held_until_s = -kBurnInS;
    for (long k = -std::lround(kBurnInS / kStepS); k <= steps; ++k) {
      const double t = static_cast<double>(k) * kStepS;
      if (t >= held_until_s - 1e-9) held_until_s = t + commands.Draw(port, starboard);
      if (k >= 0 && k % 20 == 0)
        recording.gnss.push_back(sensors.Fix(origin_s + t, boat_state.Now()));
      if (k >= 0 && k % 2 == 0) {
        recording.heading.push_back(sensors.Heading(origin_s + t, boat_state.Now()));
      }
      if (k % command_steps == 0) {
        recording.thrusters.push_back({sensors.CommandStamp(origin_s + t),
                                       std::round(vehicle.port.PulseWidth(port)),
                                       std::round(vehicle.starboard.PulseWidth(starboard))});
      }
      boat_state.Step(port, starboard);
    }
    origin_s += mission.segment_s + kGapS;
  }
  PutInOrder(recording);
  return recording;
}

TrueRun SimulateTrueRun(const Boat& boat, const SimulatedEnvironment& environment,
                        const Mission& mission, double duration_s, double step_s,
                        std::uint64_t seed) {
  Commands commands(seed, mission.command_share);
  BoatState boat_state(boat, environment, seed);
  boat_state.Restart(0.0);
  double port = 0.0;
  double starboard = 0.0;
  commands.Draw(port, starboard);
  for (long k = 0; k < std::lround(kBurnInS / kStepS); ++k) boat_state.Step(port, starboard);
  TrueRun run{
      {0.0}, {{port, starboard}}, {boat_state.Now().u, boat_state.Now().v, boat_state.Now().r}, {}};
  double held_until_s = 2.0;
  const long every = std::lround(step_s / kStepS);
  for (long k = 0; k < std::lround(duration_s / kStepS); ++k) {
    const double t = static_cast<double>(k) * kStepS;
    if (t >= held_until_s - 1e-9) {
      held_until_s = t + commands.Draw(port, starboard);
      run.command_times_s.push_back(t);
      run.commands.push_back({port, starboard});
    }
    boat_state.Step(port, starboard);
    if ((k + 1) % every == 0)
      run.nu.push_back({boat_state.Now().u, boat_state.Now().v, boat_state.Now().r});
  }
  return run;
}

}  // namespace telltale::coverage
