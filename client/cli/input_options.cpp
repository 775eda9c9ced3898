#include "telltale/client/cli/input_options.hpp"

#include <iostream>
#include <utility>

#include "telltale/client/cli/progress_line.hpp"
#include "telltale/client/workbench/files.hpp"
#include "telltale/client/workbench/recorded_log.hpp"

namespace telltale {
namespace {

constexpr const char* kLogFormats =
    "a recording: a telemetry log (a folder with gnss.csv, heading.csv and thrusters.csv), an "
    "ArduPilot .BIN, a .tlog, an .mcap of ROS 2 or BlueOS, a rosbag2 folder or .db3, a ROS 1 "
    ".bag, or one CSV file with --map; a file may be compressed as a whole (.gz, .zst)";

template <class Target>
CLI::Option* AddLogOption(CLI::App& command, Target& target, const std::string& description) {
  return command.add_option("--log", target, description)
      ->type_name("LOG")
      ->check(CLI::ExistingPath.description(""));
}

CLI::Option* AddFile(CLI::App& command, const std::string& name, std::filesystem::path& file,
                     const std::string& description) {
  return command.add_option(name, file, description)
      ->type_name("FILE")
      ->check(CLI::ExistingFile.description(""));
}

void AddSourceOptions(CLI::App& command, SourceOptions& options, CLI::Option* log) {
  const auto add = [&](const char* name, std::optional<int>& target, const CLI::Range& range,
                       const char* description) {
    command.add_option(name, target, description)
        ->type_name("N")
        ->check(range.description(""))
        ->needs(log);
  };
  command
      .add_option_function<std::string>(
          "--map", [&options](const std::string& file) { options.mapping = LoadMapping(file); },
          "which columns of one CSV file, or topics of an MCAP, rosbag2 or ROS 1 recording, hold "
          "what, in which units and frames (text format)")
      ->type_name("FILE")
      ->check(CLI::ExistingFile.description(""))
      ->needs(log);
  add("--gps-instance", options.gps_instance, {0, 255},
      "of .BIN logs: the GPS receiver to take, [0, 255] (default: the one with most fixes)");
  add("--system-id", options.system_id, {1, 255},
      "of MAVLink recordings: the vehicle to take, [1, 255] (default: the one that says most)");
  add("--port-channel", options.port_channel, {1, 16},
      "the output that drives the port thruster, [1, 16], of .BIN logs to 14 (default: the one "
      "whose SERVOn_FUNCTION is 73; 1 of MAVROS)");
  add("--starboard-channel", options.starboard_channel, {1, 16},
      "the same for starboard (default: SERVOn_FUNCTION 74; 3 of MAVROS)");
}

}  // namespace

CLI::Option* LogInputs::AddTo(CLI::App& command, CLI::App& whom) {
  auto* const log = AddLogOption(
      whom, logs,
      std::string(kLogFormats) +
          ". Several are put one after the other; one that does not follow the last within a day "
          "is shifted to start 120 s after it");
  AddFile(command, "--vehicle", vehicle_file,
          "vehicle file (text format); recordings of an autopilot can do without, then their servo "
          "parameters count")
      ->needs(log);
  AddSourceOptions(command, options, log);
  return log;
}

void LogInputs::AddInputCheckTo(CLI::App& command) {
  skip_input_check = false;
  command.add_flag("--skip-input-check", skip_input_check,
                   "identify although the input shows a fault, such as swapped thrusters or "
                   "mirrored headings: telltale check says which");
}

RecordedVehicle LogInputs::Load() const {
  std::optional<Vehicle> vehicle;
  if (NamesVehicle()) {
    vehicle = LoadVehicle(vehicle_file);
  } else {
    RequireSelfDescribing(logs);
  }
  std::vector<RecordedLog> loaded;
  for (const std::filesystem::path& log : logs) {
    RawLog raw = ReadShown(log, options);
    auto fault =
        skip_input_check ? std::nullopt : FaultAsRecorded(raw.channels, raw.description, vehicle);
    loaded.push_back(Admitted(log, std::move(raw), PrintNote));
    loaded.back().fault = std::move(fault);
  }
  return Join(std::move(loaded), std::move(vehicle),
              skip_input_check ? InputFaults::kIgnored : InputFaults::kSought, PrintNote);
}

RawLog ReadShown(const std::filesystem::path& log, SourceOptions options) {
  ProgressLine line;
  options.progress = [&, stage = "reading " + NameOf(log)](double share) {
    line.Update(stage, share);
  };
  return LoadAsRecorded(log, options);
}

CLI::Option* AddLog(CLI::App& command, std::filesystem::path& log, SourceOptions& options) {
  auto* const option = AddLogOption(command, log, kLogFormats);
  AddSourceOptions(command, options, option);
  return option->required();
}

CLI::Option* AddModelFile(CLI::App& command, std::filesystem::path& file) {
  return AddFile(command, "--model", file, "model.json, as identify writes it")->required();
}

CLI::Option* AddVehicleFile(CLI::App& command, std::filesystem::path& file) {
  return AddFile(command, "--vehicle", file, "vehicle file (text format)")->required();
}

void AddIncludeRr(CLI::App& command, bool& include_reverse) {
  command.add_flag("--include-rr", include_reverse,
                   "also fit rows in which both propellers turn in reverse, which the paper leaves "
                   "out; its surge equation never takes them");
}

void PrintNote(const std::string& note) {
  std::cerr << "note: " << note << '\n';
}

}  // namespace telltale
