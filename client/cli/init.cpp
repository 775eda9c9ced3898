#include <filesystem>
#include <iostream>
#include <memory>
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

std::string ChannelText(const char* name, const PwmChannel& channel, const std::string& comment) {
  return std::string(name) + " { neutral_us: " + Plain(channel.neutral_us) +
         " full_forward_us: " + Plain(channel.full_forward_us) +
         " full_reverse_us: " + Plain(channel.full_reverse_us) + " }  # " + comment + '\n';
}

std::string FileText(const std::string& vehicle_id, const Vehicle& vehicle,
                     const std::string& origin) {
  return "# A vehicle file: what Telltale is told of one boat. Lengths are in metres, masses in\n"
         "# kilograms, pulse widths in microseconds.\n"
         "vehicle_id: \"" +
         vehicle_id +
         "\"\n\n"
         "# Distance between the two propellers. Measure it.\n"
         "propeller_separation_m: 0.57\n\n"
         "# Pulse widths of each thruster. A reversed channel has full_forward_us below\n"
         "# neutral_us. " +
         origin + "\n" + ChannelText("port     ", vehicle.port, "left, seen forward") +
         ChannelText("starboard", vehicle.starboard, "right") +
         "\n# Where the GNSS antenna sits, from the middle of the boat.\n"
         "gnss_antenna { forward_m: 0 starboard_m: 0 }\n\n"
         "# mass_kg: 15  # optional; exports in newtons need it\n";
}

void WriteVehicleFile(const InitArguments& arguments) {
  Vehicle vehicle;
  std::string origin = "Set them from the speed controllers' data sheet.";
  if (!arguments.log.empty()) {
    const RawLog log = ReadShown(arguments.log, arguments.options);
    if (!log.description || !log.description->port || !log.description->starboard) {
      PrintNote(arguments.log.string() + " says nothing of its thrusters");
    } else {
      vehicle = OrThrow(VehicleFrom(*log.description, "boat"));
      origin = "Taken from SERVOn_* of " + arguments.log.filename().string() + '.';
    }
  }
  if (std::filesystem::exists(arguments.out)) {
    throw std::runtime_error(arguments.out.string() + " exists already; name another file");
  }
  const std::string text = FileText(VehicleIdLike(arguments.out.stem().string()), vehicle, origin);
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
