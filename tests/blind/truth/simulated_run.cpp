#include "simulated_run.hpp"

#include <algorithm>
#include <cmath>

#include "thruster.hpp"

namespace blind::truth {
namespace {

/// A body on a slack line from the stern.
class Tow {
 public:
  explicit Tow(double mass_kg) : mass_kg_(mass_kg), north_m_(-kLineM) {}

  BodyForce Pull(const State& boat, double dt_s) {
    if (mass_kg_ == 0.0) return {};
    const double c = std::cos(boat.heading_rad), s = std::sin(boat.heading_rad);
    const double sway_at_stern = boat.sway_mps + kSternM * boat.yaw_radps;
    const double to_north = boat.north_m + kSternM * c - north_m_;
    const double to_east = boat.east_m + kSternM * s - east_m_;
    const double distance = std::max(std::hypot(to_north, to_east), 1e-6);
    const double along_north = to_north / distance, along_east = to_east / distance;
    const double opening = (c * boat.surge_mps - s * sway_at_stern - north_mps_) * along_north +
                           (s * boat.surge_mps + c * sway_at_stern - east_mps_) * along_east;
    const double tension =
        distance > kLineM ? std::max(0.0, 120.0 * (distance - kLineM) + 15.0 * opening) : 0.0;
    const double drag = 0.5 * mass_kg_ * std::hypot(north_mps_, east_mps_);
    north_mps_ += dt_s * (tension * along_north - drag * north_mps_) / mass_kg_;
    east_mps_ += dt_s * (tension * along_east - drag * east_mps_) / mass_kg_;
    north_m_ += dt_s * north_mps_;
    east_m_ += dt_s * east_mps_;
    const double x = -tension * (c * along_north + s * along_east);
    const double y = -tension * (c * along_east - s * along_north);
    return {.x_n = x, .y_n = y, .n_nm = kSternM * y};
  }

 private:
  static constexpr double kLineM = 4.0;
  static constexpr double kSternM = -0.6;
  double mass_kg_;
  double north_m_;
  double east_m_ = 0.0;
  double north_mps_ = 0.0;
  double east_mps_ = 0.0;
};

/// A battery that gives less as it empties, and under load.
class Battery {
 public:
  double Share(double sag, const State& boat, double dt_s) {
    constexpr double kFullShaftCubed = 369.4;  // of 5.25 kgf
    constexpr double kUsualUse = 90.0;         // full-load seconds of a usual mission
    const auto load = [](double shaft) { return std::pow(std::abs(shaft), 3) / kFullShaftCubed; };
    const double now = 0.5 * (load(boat.port_shaft) + load(boat.starboard_shaft));
    used_ += dt_s * now;
    return std::max(0.3, 1.0 - sag * (used_ / kUsualUse + 0.4 * now));
  }

 private:
  double used_ = 0.0;
};

Pulses PulsesOf(const Command& command) {
  return {.port_us = std::round(kNeutralUs + kFullUs * command.port),
          .starboard_us = std::round(kNeutralUs + kFullUs * command.starboard)};
}

/// Two outputs that follow what is heard at a limited rate, or stick.
class Outputs {
 public:
  Pulses Follow(const Pulses& heard, const Faults& faults, double dt_s) {
    const double most =
        faults.output_travel_s > 0.0 ? kFullUs * dt_s / faults.output_travel_s : 2.0 * kFullUs;
    const auto towards = [&](double now, double wanted, bool stuck) {
      return stuck ? faults.stuck_us : now + std::clamp(wanted - now, -most, most);
    };
    now_ = {.port_us = towards(now_.port_us, heard.port_us, faults.port_stuck),
            .starboard_us = towards(now_.starboard_us, heard.starboard_us, faults.starboard_stuck)};
    return now_;
  }

 private:
  Pulses now_;
};

/// The command in force so long ago, neutral before the first.
Pulses Heard(const std::vector<Pulses>& commands, int step, double delay_s) {
  const int heard_step = step - static_cast<int>(std::lround(delay_s / kStepS));
  if (heard_step < 0) return {};
  return commands[static_cast<std::size_t>(heard_step / kStepsPerCommand)];
}

}  // namespace

Track Simulate(const SimulatedRun& simulated_run, Mission mission, RandomStream rng) {
  const int steps = static_cast<int>(std::lround(simulated_run.duration_s / kStepS));
  Environment sea(rng.For("sea"));
  Tow tow(simulated_run.after.faults.tow_kg);
  Battery battery;
  Outputs outputs;
  State boat{.heading_rad = rng.For("heading").Angle()};
  Track track;
  track.states.reserve(static_cast<std::size_t>(steps) + 1);
  for (int step = 0; step <= steps; ++step) {
    const double time = step * kStepS;
    const bool changed = time >= simulated_run.onset_s;
    const Scenario& now = changed ? simulated_run.after : simulated_run.before;
    track.states.push_back(boat);
    if (step % kStepsPerCommand == 0) track.commands.push_back(PulsesOf(mission.At(time, boat)));

    const Pulses heard = Heard(track.commands, step, now.faults.command_delay_s);
    const double share = battery.Share(now.faults.sag, boat, kStepS);
    const bool weedy = sea.Weedy(now.faults.weed_share, time);
    const Pulses sent = outputs.Follow(heard, now.faults, kStepS);
    Drive drive{.port_us = sent.port_us,
                .starboard_us = sent.starboard_us,
                .port_share = share,
                .starboard_share = weedy ? 0.2 * share : share,
                .towline = {}};
    if (changed) drive.towline = tow.Pull(boat, kStepS);
    sea.Advance(now.weather, kStepS);
    const Place place{boat.north_m, boat.east_m, boat.heading_rad};
    boat = RungeKuttaStep(boat, now, drive, sea.At(now, place, time), kStepS);
  }
  return track;
}

}  // namespace blind::truth
