#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <string>

#include "telltale/client/cli/commands.hpp"
#include "telltale/client/cli/input_options.hpp"
#include "telltale/client/cli/table.hpp"
#include "telltale/client/recording/file_contents.hpp"
#include "telltale/client/recording/load_recording.hpp"
#include "telltale/client/workbench/errors.hpp"
#include "telltale/client/workbench/recorded_log.hpp"
#include "telltale/idl/codec/vehicle_file.hpp"

namespace telltale {
namespace {

struct InitArguments {
  std::filesystem::path log;  ///< empty: nothing is filled in
  SourceOptions options;
  std::filesystem::path out;
};

/// A vehicle as far as a log says it, the rest as by default.
struct FilledIn {
  Vehicle vehicle;
  std::string port_origin = "left, seen forward";
  std::string starboard_origin = "right";
};

/// Takes over what a log says of a thruster, or notes why it cannot.
void FillIn(const std::string& log, const std::string& thruster,
            const std::optional<ThrusterOutput>& output, PwmChannel& channel, std::string& origin) {
  if (output && output->range) {
    channel = *output->range;
    origin += ", channel " + std::to_string(output->channel) + " of " + log;
    return;
  }
  origin += ", not in " + log;
  PrintNote(log + " does not say how the " + thruster + " thruster is driven: " +
            (output ? output->range_fault : "no parameter names its channel") +
            "; set its pulse widths in the file");
}

FilledIn FilledFrom(const std::filesystem::path& path, const RawLog& log) {
  const LogDescription description = log.description.value_or(LogDescription{});
  const std::string name = path.filename().string();
  FilledIn filled;
  FillIn(name, "port", description.port, filled.vehicle.port, filled.port_origin);
  FillIn(name, "starboard", description.starboard, filled.vehicle.starboard,
         filled.starboard_origin);
  for (const Refusal& channel : log.lacks) {
    PrintNote(name + " lacks a channel that a model needs, " + channel.subject + ": " +
              channel.reason);
  }
  return filled;
}

std::string ChannelText(const char* name, const PwmChannel& channel, const std::string& comment) {
  return std::string(name) + " { neutral_us: " + Plain(channel.neutral_us) +
         " full_forward_us: " + Plain(channel.full_forward_us) +
         " full_reverse_us: " + Plain(channel.full_reverse_us) + " }  # " + comment + '\n';
}

std::string FileText(const std::string& vehicle_id, const FilledIn& filled) {
  return "# A vehicle file: what Telltale is told of one boat. Lengths are in metres, masses in\n"
         "# kilograms, pulse widths in microseconds.\n"
         "vehicle_id: \"" +
         vehicle_id +
         "\"\n\n"
         "# Distance between the two propellers. No log tells it: measure it.\n"
         "propeller_separation_m: 0.57\n\n"
         "# Pulse widths of each thruster. A reversed channel has full_forward_us below\n"
         "# neutral_us. What no log says stands in the speed controllers' data sheet.\n" +
         ChannelText("port     ", filled.vehicle.port, filled.port_origin) +
         ChannelText("starboard", filled.vehicle.starboard, filled.starboard_origin) +
         "\n# Where the GNSS antenna sits, from the middle of the boat. No log tells it.\n"
         "gnss_antenna { forward_m: 0 starboard_m: 0 }\n\n"
         "# mass_kg: 15  # optional; exports in newtons need it\n";
}

void WriteVehicleFile(const InitArguments& arguments) {
  if (std::filesystem::exists(arguments.out)) {
    throw std::runtime_error(arguments.out.string() + " exists already; name another file");
  }
  const FilledIn filled =
      arguments.log.empty()
          ? FilledIn()
          : FilledFrom(arguments.log, ReadShown(arguments.log, arguments.options));
  const std::string text = FileText(VehicleIdLike(arguments.out.stem().string()), filled);
  OrThrow(ParseVehicle(text, arguments.out.string()));
  WriteFile(arguments.out, text);
  std::cout << "Wrote " << arguments.out.string() << "; read it once and set what you know.\n";
}

}  // namespace

void AddInit(CLI::App& telltale) {
  const auto arguments = std::make_shared<InitArguments>();
  CLI::App& command = *telltale.add_subcommand(
      "init", "Writes a commented vehicle file, filled from what a log says");
  AddLog(command, arguments->log, arguments->options)->required(false);
  command.add_option("--out", arguments->out, "the vehicle file to write")
      ->type_name("FILE")
      ->required();
  command.footer("Example: telltale init --log 00000042.BIN --out boat.textproto");
  command.callback([arguments] { WriteVehicleFile(*arguments); });
}

}  // namespace telltale
