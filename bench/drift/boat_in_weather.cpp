#include "drift/boat_in_weather.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "support/stable_boat.hpp"
#include "telltale/core/base/degrees.hpp"
#include "telltale/core/simulation/manoeuvres.hpp"
#include "telltale/core/simulation/sensors.hpp"
#include "telltale/core/vessel/body_dynamics.hpp"

namespace telltale::drift {
namespace {

constexpr double kStepS = 0.1;
constexpr double kMinuteS = 60.0;
constexpr double kTransitS = 20.0 * kMinuteS;
constexpr double kWeatherLastsS = 7200.0;
constexpr double kStrengthSpread = 0.5;
constexpr double kTurnsRad = 1.5;
constexpr double kGust = 0.02;
constexpr double kGustLastsS = 4.0;
constexpr double kPush = 0.03;
constexpr double kHullSpread = 0.1;
constexpr double kCurrentMps = 0.1;
constexpr std::size_t kKindsOfWork = 6;

/// One of a series of boats that differ in every coefficient.
VesselModel StableBoatOf(std::uint64_t seed, double thruster_lag_s) {
  constexpr double kAtOnceS = 1e-6;
  VesselModel model = testing::StableBoat(std::max(thruster_lag_s, kAtOnceS));
  WhiteSource white(seed, 8);
  for (Eigen::VectorXd& theta : model.theta) {
    for (double& coefficient : theta) coefficient *= std::exp(kHullSpread * white());
  }
  return model;
}

VesselModel WithDrag(VesselModel model, double drag) {
  for (const Eigen::Index damping : {0, 3}) model.theta[0][damping] *= drag;
  for (const Eigen::Index damping : {0, 6}) model.theta[1][damping] *= drag;
  for (const Eigen::Index damping : {3, 7}) model.theta[2][damping] *= drag;
  return model;
}

Manoeuvre MinuteOfWork(std::size_t kind, RandomEngine& random) {
  const double thrust = 0.3 + 0.05 * static_cast<double>(DrawBelow(random, 13));
  switch (kind) {
    case 0: return Circle(0.5 * thrust, 0.3, kMinuteS);
    case 1: return Circle(0.5 * thrust, -0.3, kMinuteS);
    case 2: return RandomSteps({{0.1, 0.1}, {1.0, 1.0}}, 1.4, 5.0, kMinuteS, random());
    case 3: return RandomSteps({{-0.7, 0.1}, {-0.1, 1.0}}, 1.4, 5.0, kMinuteS, random());
    case 4: return Repeated(Zigzag(0.5, 0.4, 4, 5.0), kMinuteS);
    default: return Repeated(Zigzag(thrust, 0.1, 2, 10.0), kMinuteS);
  }
}

GaussMarkov Slow(double sigma, std::uint64_t seed, std::uint64_t stream) {
  return {sigma, kWeatherLastsS, kStepS, WhiteSource(seed, stream)};
}

GaussMarkov Gusts(std::uint64_t seed, std::uint64_t stream) {
  return {kGust, kGustLastsS, kStepS, WhiteSource(seed, stream)};
}

}  // namespace

BoatInWeather::BoatInWeather(std::uint64_t seed, double thruster_lag_s)
    : model_(StableBoatOf(seed, thruster_lag_s)),
      random_(seed),
      seed_(seed),
      strength_(Slow(kStrengthSpread, seed, 1)),
      wind_direction_(Slow(kTurnsRad, seed, 2)),
      gusts_{Gusts(seed, 3), Gusts(seed, 4), Gusts(seed, 5)},
      current_{Slow(kCurrentMps, seed, 6), Slow(kCurrentMps, seed, 7)} {}

Recording BoatInWeather::Record(double duration_s, Work work, const Fault& fault) {
  const VesselModel model = WithDrag(model_, fault.drag);
  std::vector<TimedCommand> commands;
  if (work == Work::kVaried) commands = VariedCommands(duration_s);
  std::vector<TimedState> track;
  std::size_t now = 0;
  const auto steps = static_cast<std::size_t>(std::lround(duration_s / kStepS));
  const double begun_s = time_s_;
  for (std::size_t k = 0; k < steps; ++k) {
    time_s_ = begun_s + static_cast<double>(k) * kStepS;
    while (now + 1 < commands.size() && commands[now + 1].time_s <= time_s_ + 1e-9) ++now;
    const PropellerCommand delta =
        work == Work::kVaried ? commands[now].delta : HoldCourse(time_s_);
    track.push_back({time_s_, state_, delta});
    Advance(model, delta, fault.port_thrust);
  }
  time_s_ = begun_s + duration_s;
  SensorOptions sensors;
  sensors.heading_period_s = kStepS;
  sensors.position_noise_m = 0.02;
  sensors.heading_noise_deg = 0.3;
  sensors.seed = random_();
  Recording recording = Measure(track, VehicleInWeather(), sensors);
  for (HeadingSample& heading : recording.heading) {
    heading.heading_deg = Wrap360(heading.heading_deg + fault.compass_deg);
  }
  return recording;
}

std::vector<TimedCommand> BoatInWeather::VariedCommands(double duration_s) {
  std::vector<Manoeuvre> minutes;
  const std::size_t first = DrawBelow(random_, kKindsOfWork);
  for (std::size_t minute = 0; kMinuteS * static_cast<double>(minute) < duration_s; ++minute) {
    minutes.push_back(MinuteOfWork((first + minute) % kKindsOfWork, random_));
  }
  return Schedule(minutes, time_s_);
}

/// A proportional autopilot with damping.
PropellerCommand BoatInWeather::HoldCourse(double time_s) {
  if (time_s >= course_until_s_) {
    course_until_s_ = time_s + kTransitS;
    course_rad_ = 0.01 * static_cast<double>(DrawBelow(random_, 628));
    course_thrust_ = 0.3 + 0.05 * static_cast<double>(DrawBelow(random_, 9));
  }
  const double off = std::remainder(course_rad_ - state_.eta.psi_rad, 2.0 * std::numbers::pi);
  const double turn = std::clamp(0.5 * off - 0.5 * state_.nu.r, -0.25, 0.25);
  return {course_thrust_ + turn, course_thrust_ - turn};
}

void BoatInWeather::Advance(const VesselModel& model, const PropellerCommand& delta,
                            double port_thrust) {
  const BodyDynamics dynamics(model);
  const std::array commands = {PropellerCommand{delta.port, 0.0},
                               PropellerCommand{0.0, delta.starboard}};
  for (std::size_t side = 0; side < commands.size(); ++side) {
    thrust_[side] = model.ThrustAfter(thrust_[side], commands[side], kStepS);
  }
  const NuDot port = dynamics.Propelled(thrust_[0]);
  const NuDot starboard = dynamics.Propelled(thrust_[1]);
  const double strength = std::exp(strength_.Next());
  const double off_bow = wind_direction_.Next() - state_.eta.psi_rad;
  NuDot applied{port_thrust * port.u + starboard.u, port_thrust * port.v + starboard.v,
                port_thrust * port.r + starboard.r};
  applied.u += strength * (gusts_[0].Next() + kPush * std::cos(off_bow));
  applied.v += strength * (gusts_[1].Next() + kPush * std::sin(off_bow));
  applied.r += strength * gusts_[2].Next();
  const Nu next = dynamics.Step(applied, state_.nu, kStepS);
  state_.eta = NextPose(state_.eta, state_.nu, next, kStepS);
  state_.eta.x_m += kStepS * current_[0].Next();
  state_.eta.y_m += kStepS * current_[1].Next();
  state_.nu = next;
}

Vehicle VehicleInWeather() {
  return testing::StableBoatVehicle();
}

}  // namespace telltale::drift
