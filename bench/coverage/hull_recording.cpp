#include "coverage/hull_recording.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>

#include "telltale/core/base/degrees.hpp"
#include "telltale/core/base/gauss_markov.hpp"
#include "telltale/core/base/random.hpp"
#include "telltale/core/data/north_east_frame.hpp"

namespace telltale::coverage {
namespace {

constexpr double kStepS = 0.01;
constexpr double kBurnInS = 20.0;
constexpr double kSettlingS = 1.5;

// A broad band about the peak: a damped oscillator driven by white noise.
class Waves {
 public:
  Waves(double sigma, double peak_hz, std::uint64_t seed, std::uint64_t stream)
      : white_(seed, stream), omega_(2.0 * std::numbers::pi * peak_hz) {
    drive_ = sigma * std::sqrt(4.0 * kDamping * std::pow(omega_, 3) / kStepS);
  }

  double Next() {
    const double acceleration = -2.0 * kDamping * omega_ * rate_ - omega_ * omega_ * value_;
    rate_ += kStepS * (acceleration + drive_ * white_());
    value_ += kStepS * rate_;
    return value_;
  }

 private:
  static constexpr double kDamping = 0.15;
  WhiteSource white_;
  double omega_;
  double drive_;
  double value_ = 0.0;
  double rate_ = 0.0;
};

// Steps held for seconds; an autopilot that steers about them changes the commands at 50 Hz.
class Pilot {
 public:
  // Steps begin at multiples of `grain_s`.
  Pilot(double grain_s, bool steers, std::uint64_t seed)
      : engine_(RandomEngine::Stream(seed, 100)),
        grain_s_(grain_s),
        steers_(steers),
        trim_(0.15, 1.0, kPilotPeriodS, WhiteSource(seed, 101)) {}

  PropellerCommand At(long step) {
    const double time_s = static_cast<double>(step) * kStepS;
    if (time_s >= held_until_s_ - 1e-9) {
      held_until_s_ = time_s + grain_s_ * std::round((1.5 + 4.5 * Unit()) / grain_s_);
      Draw();
    }
    if (!steers_) return held_;
    if (step % kPilotSteps == 0) steering_ = trim_.Next();
    return {std::clamp(held_.port + steering_, -1.0, 1.0),
            std::clamp(held_.starboard - steering_, -1.0, 1.0)};
  }

 private:
  static constexpr long kPilotSteps = 2;
  static constexpr double kPilotPeriodS = kPilotSteps * kStepS;

  double Unit() { return std::uniform_real_distribution<double>(0.0, 1.0)(engine_); }

  void Draw() {
    const double kind = Unit();
    const double first = Unit();
    const double second = Unit();
    held_ = {kind < 0.7 ? first : -0.7 * first, kind < 0.5 || kind >= 0.7 ? second : -0.7 * second};
    if (kind > 0.9) held_ = {};
  }

  RandomEngine engine_;
  double grain_s_;
  bool steers_;
  GaussMarkov trim_;
  PropellerCommand held_;
  double steering_ = 0.0;
  double held_until_s_ = -1e9;
};

struct Pose {
  double north = 0.0;
  double east = 0.0;
  double psi = 0.0;
};

// The hull in its sea, step by step.
class HullState {
 public:
  HullState(const Hull& hull, const Sea& sea, std::uint64_t seed)
      : hull_(hull),
        share_(1.0 - std::exp(-kStepS / hull.thrust_time_constant_s)),
        gusts_{Gust(sea, 0, seed), Gust(sea, 1, seed), Gust(sea, 2, seed)},
        waves_{Waves(sea.wave_sigma, sea.wave_peak_hz, seed, 20),
               Waves(sea.wave_sigma, sea.wave_peak_hz, seed, 21),
               Waves(sea.wave_sigma, sea.wave_peak_hz, seed, 22)},
        variation_{GaussMarkov(sea.current_variation, 120.0, kStepS, WhiteSource(seed, 30)),
                   GaussMarkov(sea.current_variation, 120.0, kStepS, WhiteSource(seed, 31))} {
    WhiteSource steady(seed, 32);
    current_ = sea.current_m_s * Eigen::Vector2d(steady(), steady());
    pose.psi = 2.0 * std::numbers::pi * steady();
    nu = {0.3, 0.0, 0.0};
  }

  void Step(const PropellerCommand& command) {
    Follow(command, 0.5);
    Eigen::Vector3d disturbance;
    for (std::size_t i = 0; i < 3; ++i) {
      disturbance[static_cast<Eigen::Index>(i)] = gusts_[i].Next() + waves_[i].Next();
    }
    const auto slope = [&](const Eigen::Vector3d& at) {
      return hull_.Acceleration(at, port_n_, starboard_n_, disturbance);
    };
    const Eigen::Vector3d before = nu;
    const Eigen::Vector3d k1 = slope(nu);
    const Eigen::Vector3d k2 = slope(nu + 0.5 * kStepS * k1);
    const Eigen::Vector3d k3 = slope(nu + 0.5 * kStepS * k2);
    const Eigen::Vector3d k4 = slope(nu + kStepS * k3);
    nu += kStepS / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
    Follow(command, 0.5);
    Move(0.5 * (before + nu));
  }

  Pose pose;
  Eigen::Vector3d nu;

 private:
  static GaussMarkov Gust(const Sea& sea, Eigen::Index axis, std::uint64_t seed) {
    return {sea.gust_sigma[axis], sea.gust_time_constant_s, kStepS,
            WhiteSource(seed, 10 + static_cast<std::uint64_t>(axis))};
  }

  void Follow(const PropellerCommand& command, double steps) {
    const double share = 1.0 - std::pow(1.0 - share_, steps);
    port_n_ += share * ((1.0 - hull_.imbalance) * hull_.thrust(command.port) - port_n_);
    starboard_n_ +=
        share * ((1.0 + hull_.imbalance) * hull_.thrust(command.starboard) - starboard_n_);
  }

  void Move(const Eigen::Vector3d& mean) {
    const double psi = pose.psi + 0.5 * kStepS * mean[2];
    pose.north += kStepS * (std::cos(psi) * mean[0] - std::sin(psi) * mean[1] + current_[0] +
                            variation_[0].Next());
    pose.east += kStepS * (std::sin(psi) * mean[0] + std::cos(psi) * mean[1] + current_[1] +
                           variation_[1].Next());
    pose.psi += kStepS * mean[2];
  }

  const Hull& hull_;
  double share_;
  std::array<GaussMarkov, 3> gusts_;
  std::array<Waves, 3> waves_;
  std::array<GaussMarkov, 2> variation_;
  Eigen::Vector2d current_;
  double port_n_ = 0.0;
  double starboard_n_ = 0.0;
};

// Fixes and headings of the hull with their errors, stamped by the clocks.
class Recorder {
 public:
  Recorder(const Vehicle& vehicle, const Sea& sea, const Clocks& clocks, std::uint64_t seed)
      : vehicle_(vehicle),
        sea_(sea),
        clocks_(clocks),
        white_(seed, 1),
        engine_(RandomEngine::Stream(seed, 2)),
        drift_{GaussMarkov(sea.fix_drift_m, 20.0, 0.2, WhiteSource(seed, 3)),
               GaussMarkov(sea.fix_drift_m, 20.0, 0.2, WhiteSource(seed, 4))},
        misalignment_deg_(sea.misalignment_deg * WhiteSource(seed, 5)()) {}

  void TakeFix(double time_s, const Pose& pose) {
    const double c = std::cos(pose.psi);
    const double s = std::sin(pose.psi);
    const LeverArm& arm = vehicle_.gnss_antenna;
    const GeographicPosition at =
        frame_.Inverse({pose.north + c * arm.forward_m - s * arm.starboard_m + Error(0),
                        pose.east + s * arm.forward_m + c * arm.starboard_m + Error(1)});
    std::uniform_real_distribution<double> delay(clocks_.least_fix_delay_s,
                                                 std::nextafter(clocks_.greatest_fix_delay_s, 1.0));
    recording_.gnss.push_back({Stamp(time_s + delay(engine_)), at.latitude_deg, at.longitude_deg});
  }

  void TakeHeading(double time_s, const Pose& pose) {
    const double deg =
        pose.psi * kDegreesPerRadian + misalignment_deg_ + sea_.heading_noise_deg * white_();
    recording_.heading.push_back({Stamp(time_s), Wrap360(deg)});
  }

  void TakeCommand(double time_s, const PropellerCommand& command) {
    recording_.thrusters.push_back({Stamp(time_s - clocks_.command_delay_s),
                                    std::round(vehicle_.port.PulseWidth(command.port)),
                                    std::round(vehicle_.starboard.PulseWidth(command.starboard))});
  }

  Recording InOrder() {
    PutInOrder(recording_);
    return std::move(recording_);
  }

 private:
  double Error(std::size_t axis) { return sea_.fix_noise_m * white_() + drift_[axis].Next(); }
  double Stamp(double time_s) { return time_s + clocks_.jitter_s * white_(); }

  const Vehicle vehicle_;
  const Sea& sea_;
  const Clocks& clocks_;
  NorthEastFrame frame_{{37.4205, -5.9944}};
  WhiteSource white_;
  RandomEngine engine_;
  std::array<GaussMarkov, 2> drift_;
  double misalignment_deg_;
  Recording recording_;
};

}  // namespace

Recording RecordHull(const Hull& hull, const Sea& sea, const Clocks& clocks, double duration_s,
                     double start_s, std::uint64_t seed) {
  HullState state(hull, sea, seed);
  Pilot pilot(clocks.sampled ? kStepS : clocks.command_period_s, clocks.steered, seed);
  Recorder recorder(VehicleOf(hull), sea, clocks, seed);
  const long command_steps = std::lround(clocks.command_period_s / kStepS);
  const long steps = std::lround(duration_s / kStepS);
  for (long k = -std::lround(kBurnInS / kStepS); k <= steps; ++k) {
    const double time_s = start_s + static_cast<double>(k) * kStepS;
    const PropellerCommand command = pilot.At(k);
    if (k >= 0 && k % 20 == 0) recorder.TakeFix(time_s, state.pose);
    if (k >= 0 && k % 10 == 0) recorder.TakeHeading(time_s, state.pose);
    if (k % command_steps == 0) recorder.TakeCommand(time_s, command);
    state.Step(command);
  }
  return recorder.InOrder();
}

HullRun RunHull(const Hull& hull, const Sea& sea, double duration_s, double step_s,
                std::uint64_t seed) {
  HullState state(hull, sea, seed);
  Pilot pilot(kStepS, false, seed);
  for (long k = -std::lround(kBurnInS / kStepS); k < 0; ++k) state.Step(pilot.At(k));
  // The first command is held until the thrusters have settled on it.
  PropellerCommand command = pilot.At(0);
  for (long k = 0; k < std::lround(kSettlingS / kStepS); ++k) state.Step(command);
  HullRun run;
  run.start = {state.nu[0], state.nu[1], state.nu[2]};
  run.commands.push_back({0.0, command});
  const long steps = std::lround(duration_s / kStepS);
  const long every = std::lround(step_s / kStepS);
  run.nu.resize(3, steps / every);
  for (long k = 0; k < steps; ++k) {
    const PropellerCommand now = pilot.At(k);
    if (now.port != command.port || now.starboard != command.starboard) {
      command = now;
      run.commands.push_back({static_cast<double>(k) * kStepS, command});
    }
    state.Step(command);
    if ((k + 1) % every == 0) run.nu.col((k + 1) / every - 1) = state.nu;
  }
  return run;
}

}  // namespace telltale::coverage
