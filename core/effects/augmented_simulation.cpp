#include "telltale/core/effects/augmented_simulation.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "telltale/core/base/contract.hpp"
#include "telltale/core/data/held_commands.hpp"
#include "telltale/core/effects/augmented_boat.hpp"

namespace telltale {
namespace {

HeldCommands Held(const std::vector<TimedCommand>& commands) {
  const Vehicle vehicle;
  std::vector<ThrusterSample> samples;
  for (const TimedCommand& command : commands) {
    samples.push_back({command.time_s, vehicle.port.PulseWidth(command.delta.port),
                       vehicle.starboard.PulseWidth(command.delta.starboard)});
  }
  return {samples, vehicle};
}

}  // namespace

std::vector<TimedState> Simulate(const AugmentedModel& model,
                                 const std::vector<TimedCommand>& commands, double end_s,
                                 double step_s, const HullParticulars& hull) {
  Require(!commands.empty() && step_s > 0.0, "commands and a step");
  const double start_s = commands.front().time_s;
  Require(end_s > start_s, "an end after the first command");
  const AugmentedBoat boat(model, {start_s, end_s - start_s}, hull);
  const HeldCommands held = Held(commands);
  const auto steps = static_cast<std::size_t>(std::floor((end_s - start_s) / step_s + 1e-9));
  const std::vector<Drive> drives = boat.DrivesAlong(held, start_s, step_s, steps);
  std::vector<TimedState> track;
  for (const Pose& pose : boat.Simulate({}, drives, start_s, step_s)) {
    const double time_s = start_s + static_cast<double>(track.size()) * step_s;
    track.push_back({time_s, {pose.eta, pose.nu}, held.At(time_s)});
  }
  return track;
}

Recording Measure(const std::vector<TimedState>& track, const AugmentedModel& model,
                  const Vehicle& vehicle, const SensorOptions& options) {
  const AugmentedBoat boat(model, RecordingFrame{});
  Vehicle real = vehicle;
  real.gnss_antenna.forward_m += boat.AntennaShift().forward_m;
  real.gnss_antenna.starboard_m += boat.AntennaShift().starboard_m;
  Recording recording = Measure(track, real, options);
  constexpr double kDegree = std::numbers::pi / 180.0;
  for (HeadingSample& sample : recording.heading) {
    const double turned_deg = boat.MeasuredHeadingRad(sample.heading_deg * kDegree) / kDegree;
    sample.heading_deg = std::fmod(turned_deg + 360.0, 360.0);
  }
  for (GnssFix& fix : recording.gnss) fix.time_s += boat.LatencyS();
  return recording;
}

}  // namespace telltale
