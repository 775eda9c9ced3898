#include <cstdint>
#include <exception>
#include <filesystem>
#include <iostream>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>

#include "telltale/client/recording/telemetry_log/telemetry_log.hpp"
#include "telltale/client/twin/faults.hpp"
#include "telltale/core/paper/paper_mission.hpp"
#include "telltale/core/paper/sample_mission.hpp"
#include "telltale/core/paper/yellowfish.hpp"
#include "telltale/core/simulation/manoeuvres.hpp"
#include "telltale/core/simulation/sensors.hpp"

namespace telltale {
namespace {

struct TwinRecordingOptions {
  std::filesystem::path out;
  std::string mission = "sample";
  std::string structure = "static";
  double duration_s = kSampleMissionDurationS;
  std::uint64_t seed = 1;
  SensorOptions sensors;
  double starts_at_s = 0.0;
  TwinFaults faults;
};

void ShiftTimes(double by_s, Recording& recording) {
  for (GnssFix& fix : recording.gnss) fix.time_s += by_s;
  for (HeadingSample& sample : recording.heading) sample.time_s += by_s;
  for (ThrusterSample& sample : recording.thrusters) sample.time_s += by_s;
}

Recording SimulateMission(const TwinRecordingOptions& options) {
  const VesselModel twin =
      options.structure == "dynamic" ? YellowfishLaggingTwin() : YellowfishTwin();
  SensorOptions sensors = options.sensors;
  sensors.seed = options.seed;
  if (options.mission == "paper") return RecordPaperMission(twin, sensors, options.seed);
  constexpr double kStepS = 0.01;
  const auto commands = SampleMission(options.seed);
  const VesselState start{{}, {}, twin.SteadyThrust(commands.front().delta)};
  std::vector<TimedState> track = Simulate(twin, start, commands, options.duration_s, kStepS);
  if (options.faults.port_strength < 1.0) {
    track = SimulateWeak(twin, options.faults, std::move(track));
  }
  Recording recording = Measure(track, YellowfishVehicle(), sensors);
  JumpClock(options.faults, recording);
  ShiftTimes(options.starts_at_s, recording);
  return recording;
}

void Record(const TwinRecordingOptions& options) {
  WriteTelemetryLog(options.out, SimulateMission(options));
}

/// Of the sample mission alone.
void AddFaults(CLI::App& app, TwinFaults& faults) {
  const CLI::Range of_mission(0.0, kSampleMissionDurationS);
  app.add_option("--port-strength", faults.port_strength,
                 "Share of its thrust that the port propeller gives; of the static structure")
      ->check(CLI::Range(0.1, 1.0))
      ->capture_default_str();
  app.add_option("--weak-from", faults.weak_from_s, "Since when, seconds of the sample mission")
      ->check(of_mission)
      ->capture_default_str();
  app.add_option("--clock-jump", faults.clock_jump_s, "How far the clock jumps ahead, seconds")
      ->check(CLI::Range(0.0, 1e6))
      ->capture_default_str();
  app.add_option("--clock-jumps-at", faults.clock_jumps_at_s,
                 "When it does so, seconds of the sample mission")
      ->check(of_mission);
}

int Main(int argc, char** argv) {
  CLI::App app("Records what the sensors of the simulated Yellowfish report on a sample mission.");
  TwinRecordingOptions options;
  app.add_option("--out", options.out, "Folder the telemetry log is written to")->required();
  app.add_option("--mission", options.mission,
                 "sample (ten minutes), or paper (127 segments, 16,025 points, 53.4 minutes)")
      ->check(CLI::IsMember({"sample", "paper"}))
      ->capture_default_str();
  app.add_option("--structure", options.structure,
                 "Of the thrusters: static, or dynamic (they lag)")
      ->check(CLI::IsMember({"static", "dynamic"}))
      ->capture_default_str();
  app.add_option("--duration", options.duration_s, "Seconds of the sample mission, from its start")
      ->check(CLI::Range(10.0, kSampleMissionDurationS))
      ->capture_default_str();
  app.add_option("--seed", options.seed, "Of the mission's random steps and the sensors' noise")
      ->capture_default_str();
  app.add_option("--position-noise", options.sensors.position_noise_m, "One sigma per axis, m")
      ->check(CLI::Range(0.0, 10.0))
      ->capture_default_str();
  app.add_option("--heading-noise", options.sensors.heading_noise_deg, "One sigma, degrees")
      ->check(CLI::Range(0.0, 45.0))
      ->capture_default_str();
  app.add_option("--starts-at", options.starts_at_s,
                 "Of the boat's clock at the start of the sample mission, seconds")
      ->check(CLI::Range(0.0, 1e9))
      ->capture_default_str();
  AddFaults(app, options.faults);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    constexpr int kUsageError = 2;
    return app.exit(error) == 0 ? 0 : kUsageError;
  }
  Record(options);
  return 0;
}

}  // namespace
}  // namespace telltale

int main(int argc, char** argv) {
  try {
    return telltale::Main(argc, argv);
  } catch (const std::exception& error) {
    std::cerr << "telltale_twin: " << error.what() << '\n';
    return 1;
  }
}
