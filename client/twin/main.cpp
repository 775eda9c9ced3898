#include <cstdint>
#include <exception>
#include <filesystem>
#include <iostream>
#include <string>

#include <CLI/CLI.hpp>

#include "telltale/client/recording/telemetry_log/telemetry_log.hpp"
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
};

Recording SimulateMission(const TwinRecordingOptions& options) {
  const VesselModel twin =
      options.structure == "dynamic" ? YellowfishLaggingTwin() : YellowfishTwin();
  SensorOptions sensors = options.sensors;
  sensors.seed = options.seed;
  if (options.mission == "paper") return RecordPaperMission(twin, sensors, options.seed);
  constexpr double kStepS = 0.01;
  const auto commands = SampleMission(options.seed);
  const VesselState start{{}, {}, twin.SteadyThrust(commands.front().delta)};
  return Measure(Simulate(twin, start, commands, options.duration_s, kStepS), YellowfishVehicle(),
                 sensors);
}

void Record(const TwinRecordingOptions& options) {
  WriteTelemetryLog(options.out, SimulateMission(options));
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
