#include "telltale/client/cli/input_options.hpp"

#include <algorithm>
#include <array>
#include <iostream>
#include <stdexcept>
#include <utility>

#include "telltale/client/cli/exit_codes.hpp"
#include "telltale/client/cli/table.hpp"
#include "telltale/client/recording/dataflash/dataflash_log.hpp"
#include "telltale/client/recording/file_contents.hpp"
#include "telltale/client/recording/load_recording.hpp"
#include "telltale/client/recording/telemetry_log/telemetry_log.hpp"
#include "telltale/core/base/contract.hpp"
#include "telltale/core/data/input_check.hpp"
#include "telltale/idl/codec/json/model.hpp"
#include "telltale/idl/codec/mapping_file.hpp"
#include "telltale/idl/codec/vehicle_file.hpp"

namespace telltale {
namespace {

std::string TextOf(const std::filesystem::path& file) {
  auto text = ReadFile(file);
  if (!text) throw std::runtime_error(text.error().subject + ' ' + text.error().reason);
  return *std::move(text);
}

void NoteMalformed(const std::filesystem::path& file, const MalformedRows& malformed) {
  if (malformed.count == 0) return;
  std::cerr << "note: " << file.string() << ": " << malformed.count
            << " malformed rows skipped, first in line";
  for (const std::size_t line : malformed.first_lines) std::cerr << ' ' << line;
  std::cerr << '\n';
}

/// Channels that the format of a log does not record are an error of the command line.
void RequireRecordedChannels(const std::filesystem::path& log, const SourceOptions& options) {
  const std::array named = {std::pair("--port-channel", options.port_channel),
                            std::pair("--starboard-channel", options.starboard_channel)};
  for (const auto& [option, channel] : named) {
    if (!options.mapping || !channel) continue;
    throw UsageError(std::string(option) +
                     ": the mapping names the outputs; leave one of them out");
  }
  if (FormatOf(log) != LogFormat::kDataFlash) return;
  for (const auto& [option, channel] : named) {
    if (channel.value_or(1) <= kLoggedChannels) continue;
    throw UsageError(std::string(option) + ": " + log.string() + " records channels 1 to " +
                     std::to_string(kLoggedChannels) + ", not " + std::to_string(*channel));
  }
}

/// What is admitted of a log, with notes on what is not.
LoadedRecording Admitted(const std::filesystem::path& path, const RawLog& log) {
  LoadedRecording loaded = OrThrow(AdmitLog(path, log));
  if (loaded.description) {
    std::cerr << "note: " << path.string() << ": " << loaded.description->summary << '\n';
  }
  for (const Channel channel : kChannels) {
    NoteMalformed(path / (std::string(Name(channel)) + ".csv"),
                  loaded.malformed[static_cast<std::size_t>(channel)]);
  }
  if (loaded.evicted > 0) {
    std::cerr << "note: " << path.string() << ": " << loaded.evicted
              << " samples left out, older than a day or before the clock was set back\n";
  }
  return loaded;
}

// ---- the vehicle that logs describe -------------------------------------------------------------

void RequireSelfDescribing(const std::vector<std::filesystem::path>& logs) {
  const auto silent = std::find_if(logs.begin(), logs.end(), [](const auto& log) {
    return FormatOf(log) == LogFormat::kTelemetryLog;
  });
  if (silent == logs.end()) return;
  throw UsageError("--vehicle is required: " + silent->string() +
                   " is a folder of CSV files, and only recordings of autopilots say how their "
                   "thrusters are driven");
}

Vehicle DescribedBy(const LoadedRecording& loaded, const std::filesystem::path& log) {
  auto vehicle = VehicleFrom(*loaded.description, VehicleIdLike(log.stem().string()));
  if (vehicle) return *std::move(vehicle);
  Refusal refusal = std::move(vehicle).error();
  refusal.subject = log.string() + ' ' + refusal.subject;
  throw RefusedError(std::move(refusal));
}

std::string RangeText(const PwmChannel& range) {
  return Plain(range.full_reverse_us) + " us (full reverse), " + Plain(range.neutral_us) +
         " us (neutral), " + Plain(range.full_forward_us) + " us (full forward)";
}

void NoteDescribed(const Vehicle& vehicle, const LogDescription& description,
                   const std::filesystem::path& log) {
  std::cerr << "note: vehicle " << vehicle.vehicle_id << " is taken from " << log.string()
            << ": port on channel " << description.port->channel << ", " << RangeText(vehicle.port)
            << "; starboard on channel " << description.starboard->channel << ", "
            << RangeText(vehicle.starboard)
            << "; the separation of the propellers and the antenna's place are unknown, taken as "
               "zero\n";
}

void RequireSameRange(const char* thruster, const PwmChannel& first, const PwmChannel& other,
                      const std::filesystem::path& first_log,
                      const std::filesystem::path& other_log) {
  if (first == other) return;
  throw RefusedError({other_log.string() + ' ' + thruster + " thruster",
                      "ranges over " + RangeText(other) + ", but over " + RangeText(first) +
                          " in " + first_log.string(),
                      "give a vehicle file that holds for all logs, or take the logs one by one"});
}

/// The first log's vehicle, to which all others must agree.
Vehicle DescribedBy(const std::vector<LoadedRecording>& loaded,
                    const std::vector<std::filesystem::path>& logs) {
  Vehicle vehicle = DescribedBy(loaded.front(), logs.front());
  for (std::size_t i = 1; i < loaded.size(); ++i) {
    const Vehicle other = DescribedBy(loaded[i], logs[i]);
    RequireSameRange("port", vehicle.port, other.port, logs.front(), logs[i]);
    RequireSameRange("starboard", vehicle.starboard, other.starboard, logs.front(), logs[i]);
  }
  NoteDescribed(vehicle, *loaded.front().description, logs.front());
  return vehicle;
}

// ---- faults of input ----------------------------------------------------------------------------

void RequireNotRepeated(const std::vector<LoadedRecording>& loaded,
                        const std::vector<std::filesystem::path>& logs) {
  for (std::size_t i = 1; i < loaded.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (!HoldsRecording(loaded[j].recording, loaded[i].recording)) continue;
      throw RefusedError({logs[i].string(), "holds the same recording as " + logs[j].string(),
                          "give each recording once"});
    }
  }
}

/// As it was recorded: admission drops what is repeated, and with it the sign of a stuck channel.
void RequireSoundInput(const std::vector<RawLog>& recorded,
                       const std::vector<std::filesystem::path>& logs, const Vehicle& vehicle) {
  for (std::size_t i = 0; i < logs.size(); ++i) {
    const auto& samples = recorded[i].samples;
    auto fault =
        FirstFault(CheckInput(SamplesOf<GnssFix>(samples), SamplesOf<HeadingSample>(samples),
                              SamplesOf<ThrusterSample>(samples), vehicle));
    if (!fault) continue;
    fault->subject = logs[i].string() + ' ' + fault->subject;
    fault->advice += "; --skip-input-check, if you know that the input is right";
    throw RefusedError(*std::move(fault));
  }
}

// ---- options ------------------------------------------------------------------------------------

constexpr const char* kLogFormats =
    "a recording: a telemetry log (a folder with gnss.csv, heading.csv and thrusters.csv), an "
    "ArduPilot .BIN, a .tlog, an .mcap of ROS 2 or BlueOS, a rosbag2 folder or .db3, a ROS 1 "
    ".bag, or one CSV file with --map";

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
  std::vector<RawLog> recorded;  // for the check
  std::vector<LoadedRecording> loaded;
  for (const std::filesystem::path& log : logs) {
    RawLog raw = LoadAsRecorded(log, options);
    loaded.push_back(Admitted(log, raw));
    if (!skip_input_check) recorded.push_back(std::move(raw));
  }
  if (!vehicle) vehicle = DescribedBy(loaded, logs);
  if (!skip_input_check) {
    RequireNotRepeated(loaded, logs);
    RequireSoundInput(recorded, logs, *vehicle);
  }
  std::vector<Recording> recordings;
  std::vector<RecordingIdentity> identities;
  for (std::size_t i = 0; i < logs.size(); ++i) {
    identities.push_back(IdentityOf(loaded[i].recording, NameOf(logs[i])));
    recordings.push_back(std::move(loaded[i].recording));
  }
  return {Concatenate(recordings), *std::move(vehicle), std::move(identities)};
}

std::string NameOf(const std::filesystem::path& log) {
  return (log.has_filename() ? log : log.parent_path()).filename().string();
}

RawLog LoadAsRecorded(const std::filesystem::path& log, const SourceOptions& options) {
  RequireRecordedChannels(log, options);
  return OrThrow(ReadLog(log, options));
}

Recording LoadAdmitted(const std::filesystem::path& log, const SourceOptions& options) {
  return Admitted(log, LoadAsRecorded(log, options)).recording;
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

std::shared_ptr<const Mapping> LoadMapping(const std::filesystem::path& file) {
  return std::make_shared<Mapping>(OrThrow(ParseMapping(TextOf(file), file.string())));
}

Vehicle LoadVehicle(const std::filesystem::path& file) {
  return OrThrow(ParseVehicle(TextOf(file), file.string()));
}

Identification LoadModel(const std::filesystem::path& file) {
  return OrThrow(ParseModelJson(TextOf(file), file.string()));
}

Preset PresetNamed(const std::string& name) {
  Require(name == "robust" || name == "paper", "the name of a preset");
  return name == "paper" ? Preset::kPaper : Preset::kRobust;
}

PrepareOptions PrepareOptionsOf(Preset preset) {
  return preset == Preset::kPaper ? PrepareOptions::Paper() : PrepareOptions::Robust();
}

PrepareOptions PrepareOptionsOf(const Identification& model,
                                const std::optional<std::string>& preset) {
  const bool paper = preset ? PresetNamed(*preset) == Preset::kPaper
                            : model.provenance.preset == Name(Preset::kPaper);
  PrepareOptions options = PrepareOptionsOf(paper ? Preset::kPaper : Preset::kRobust);
  options.sampling_period_s = model.sampling_period_s;
  return options;
}

void NoteOtherVehicle(const Identification& model, const Vehicle& vehicle) {
  if (model.vehicle_id == vehicle.vehicle_id) return;
  std::cerr << "note: the model is of " << model.vehicle_id << ", the vehicle file of "
            << vehicle.vehicle_id << '\n';
}

}  // namespace telltale
