#include <cmath>
#include <cstdint>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "telltale/client/cli/commands.hpp"
#include "telltale/client/cli/input_options.hpp"
#include "telltale/client/cli/model_notes.hpp"
#include "telltale/client/cli/number_range.hpp"
#include "telltale/client/cli/table.hpp"
#include "telltale/client/cli/whole_number.hpp"
#include "telltale/client/recording/telemetry_log/telemetry_log.hpp"
#include "telltale/client/workbench/errors.hpp"
#include "telltale/client/workbench/files.hpp"
#include "telltale/client/workbench/simulate_model.hpp"
#include "telltale/core/effects/augmented_simulation.hpp"
#include "telltale/core/simulation/sensors.hpp"

namespace telltale {
namespace {

struct SimulateArguments {
  std::filesystem::path model_file;
  std::filesystem::path vehicle_file;
  std::filesystem::path commands_file;
  std::filesystem::path out;
  std::optional<double> step_s;
  SensorOptions sensors;
};

std::vector<TimedCommand> LoadCommands(const std::filesystem::path& file, const Vehicle& vehicle) {
  const CommandLog log = OrThrow(ReadCommands(file));
  if (log.malformed.count + log.rejected.Total() > 0) {
    PrintNote(file.string() + ": " + std::to_string(log.malformed.count) +
              " malformed rows skipped, " + RejectedText(log.rejected) + " rejected");
  }
  std::vector<TimedCommand> commands;
  for (const ThrusterSample& sample : log.commands) {
    commands.push_back({sample.time_s, vehicle.Normalise(sample.port_us, sample.starboard_us)});
  }
  return commands;
}

void SimulateLog(const SimulateArguments& arguments) {
  const Vehicle vehicle = LoadVehicle(arguments.vehicle_file);
  const Identification identification = LoadModel(arguments.model_file);
  NoteOtherVehicle(identification, vehicle, PrintNote);
  const auto commands = LoadCommands(arguments.commands_file, vehicle);
  const auto [model, track] = SimulateModel(identification, commands, vehicle, arguments.step_s);
  const Recording recording = Measure(track, model, vehicle, arguments.sensors);
  WriteTelemetryLog(arguments.out, recording);
  const VesselState& last = track.back().state;
  std::cout << arguments.out.string() << ": "
            << Fixed(track.back().time_s - track.front().time_s, 1) << " s, "
            << recording.gnss.size() << " fixes, " << recording.heading.size() << " headings, "
            << recording.thrusters.size() << " commands; ends at " << Fixed(last.eta.x_m, 1)
            << " m north, " << Fixed(last.eta.y_m, 1) << " m east, "
            << Fixed(std::hypot(last.nu.u, last.nu.v), 2) << " m/s\n";
}

}  // namespace

void AddSimulate(CLI::App& telltale) {
  const auto arguments = std::make_shared<SimulateArguments>();
  CLI::App& command = *telltale.add_subcommand(
      "simulate", "Drives a model open loop and writes what the boat's sensors would have logged");
  AddModelFile(command, arguments->model_file);
  AddVehicleFile(command, arguments->vehicle_file);
  command
      .add_option(
          "--commands", arguments->commands_file,
          "thrusters.csv: time_s,left_us,right_us; the run lasts from its first to its last "
          "row, starting from rest and heading north")
      ->type_name("FILE")
      ->required()
      ->check(CLI::ExistingFile.description(""));
  command.add_option("--out", arguments->out, "folder for the telemetry log, made if need be")
      ->type_name("DIR")
      ->required();
  command
      .add_option(
          "--step", arguments->step_s,
          "integrate with this step, seconds, [0.001, 1] (default: the discrete model as it "
          "was identified)")
      ->type_name("S")
      ->check(NumberWithin(0.001, 1.0).description(""));
  command
      .add_option("--noise-position", arguments->sensors.position_noise_m,
                  "one sigma per axis, metres, [0, 100]")
      ->type_name("M")
      ->capture_default_str()
      ->check(NumberWithin(0.0, 100.0).description(""));
  command
      .add_option("--noise-heading", arguments->sensors.heading_noise_deg,
                  "one sigma, degrees, [0, 90]")
      ->type_name("DEG")
      ->capture_default_str()
      ->check(NumberWithin(0.0, 90.0).description(""));
  command.add_option("--seed", arguments->sensors.seed, "of the sensor noise")
      ->type_name("N")
      ->check(WholeNumber())
      ->capture_default_str();
  command.footer(
      "Sensors as in the paper: GNSS at 5 Hz, heading at 50 Hz, thrusters at 10 Hz.\n"
      "Example: telltale simulate --model model.json --vehicle boat.textproto "
      "--commands thrusters.csv --out simulated");
  command.callback([arguments] { SimulateLog(*arguments); });
}

}  // namespace telltale
