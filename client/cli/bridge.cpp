#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "telltale/client/bus/participant.hpp"
#include "telltale/client/cli/bridge_commands.hpp"
#include "telltale/client/cli/commands.hpp"
#include "telltale/client/cli/exit_codes.hpp"
#include "telltale/client/cli/input_options.hpp"
#include "telltale/client/cli/number_range.hpp"
#include "telltale/client/recording/ros/ros_topic.hpp"
#include "telltale/client/workbench/errors.hpp"
#include "telltale/client/workbench/files.hpp"

namespace telltale {
namespace {

struct BridgeArguments {
  std::optional<MavlinkAddress> address;
  bool from_ros2 = false;
  std::string vehicle_id;  ///< empty: the default of the kind of source
  std::vector<int> systems;
  SourceOptions source;
  std::vector<std::string> channels;
  MavlinkBridgeOptions mavlink;
  Ros2SourceOptions ros2;
  std::vector<std::string> announced_files;
  std::uint32_t domain = 0;
};

std::vector<Vehicle> AnnouncedBy(const BridgeArguments& arguments) {
  std::vector<Vehicle> vehicles;
  for (const std::string& file : arguments.announced_files) vehicles.push_back(LoadVehicle(file));
  return vehicles;
}

ChannelChoice ChannelsOf(const BridgeArguments& arguments) {
  ChannelChoice channels;
  for (const std::string& name : arguments.channels) channels.insert(*ChannelNamed(name));
  return channels;
}

void RequireTwoOutputs(std::optional<int> port, std::optional<int> starboard) {
  const auto fault = SameChannel(port, starboard);
  if (fault) throw UsageError("--starboard-channel: " + fault->reason + "; " + fault->advice);
}

void FromMavlink(const BridgeArguments& arguments) {
  RequireTwoOutputs(arguments.source.port_channel, arguments.source.starboard_channel);
  MavlinkBridgeOptions options = arguments.mavlink;
  if (!arguments.vehicle_id.empty()) options.vehicle_id = arguments.vehicle_id;
  options.systems = {arguments.systems.begin(), arguments.systems.end()};
  options.port_channel = arguments.source.port_channel;
  options.starboard_channel = arguments.source.starboard_channel;
  options.channels = ChannelsOf(arguments);
  if (const auto fault = options.Fault()) throw UsageError("--vehicle-id: " + *fault);
  BridgeMavlink(*arguments.address, options, AnnouncedBy(arguments), arguments.domain);
}

void FromRos2(const BridgeArguments& arguments) {
  const RosOutputChannels outputs(arguments.source);
  RequireTwoOutputs(outputs.port, outputs.starboard);
  Ros2SourceOptions options = arguments.ros2;
  if (!arguments.vehicle_id.empty()) options.bridge.vehicle_id = arguments.vehicle_id;
  options.bridge.source = arguments.source;
  options.bridge.channels = ChannelsOf(arguments);
  if (const auto fault = options.bridge.Fault()) throw UsageError(*fault);
  BridgeRos2(options, AnnouncedBy(arguments), arguments.domain);
}

CLI::Option* AddMavlink(CLI::App& sources, BridgeArguments& arguments) {
  return sources
      .add_option_function<std::string>(
          "--mavlink",
          [&arguments](const std::string& text) { arguments.address = *ParseMavlinkAddress(text); },
          "where the stream comes from: udp:HOST:PORT is listened on, tcp:HOST:PORT is connected "
          "to, serial:DEVICE:BAUD is opened")
      ->type_name("ADDRESS")
      ->check(CLI::Validator(
          [](const std::string& text) {
            const auto address = ParseMavlinkAddress(text);
            return address ? std::string() : address.error();
          },
          ""));
}

void AddMavlinkOptions(CLI::App& command, BridgeArguments& arguments, CLI::Option* mavlink) {
  MavlinkBridgeOptions& options = arguments.mavlink;
  command
      .add_option("--system-id", arguments.systems,
                  "of MAVLink: take these vehicles alone, [1, 255] (default: all)")
      ->type_name("N")
      ->check(CLI::Range(1, 255).description(""))
      ->needs(mavlink);
  CLI::Option* const rate =
      command
          .add_option("--rate", options.rate_hz,
                      "of MAVLink: how often to ask for each message, in Hz, [0.1, 100]")
          ->type_name("HZ")
          ->check(NumberWithin(0.1, 100.0))
          ->capture_default_str()
          ->needs(mavlink);
  command
      .add_flag("--listen-only", options.listen_only,
                "of MAVLink: send nothing, no heartbeat and no requests")
      ->needs(mavlink)
      ->excludes(rate);
}

void AddRos2Options(CLI::App& command, BridgeArguments& arguments, CLI::Option* ros2) {
  Ros2SourceOptions& options = arguments.ros2;
  command
      .add_option("--namespace", options.bridge.name_space,
                  "of ROS 2: take the topics below this namespace, in which {vehicle} stands for "
                  "part of a name (default: /{vehicle}; / where --vehicle-id has no {vehicle})")
      ->type_name("PATTERN")
      ->needs(ros2);
  command
      .add_option_function<std::string>(
          "--map",
          [&arguments](const std::string& file) { arguments.source.mapping = LoadMapping(file); },
          "of ROS 2: which topics hold what, in which units and frames (text format; default: by "
          "the types of the topics)")
      ->type_name("FILE")
      ->check(CLI::ExistingFile.description(""))
      ->needs(ros2);
  command
      .add_option("--ros-domain", options.domain,
                  "ROS_DOMAIN_ID of the topics, [0, 101] (default: that of --domain)")
      ->type_name("N")
      ->check(CLI::Range(0u, kHighestDomain).description(""))
      ->needs(ros2);
  command
      .add_flag_callback(
          "--telemetry-only", [&options] { options.publish = false; },
          "of ROS 2: publish neither models nor quality to it")
      ->needs(ros2);
}

void AddSharedOptions(CLI::App& command, BridgeArguments& arguments) {
  command
      .add_option("--vehicle-id", arguments.vehicle_id,
                  "the vehicles' ids: {system} stands for the system id of MAVLink, {vehicle} for "
                  "what --namespace finds (default: mavlink-{system}; {vehicle})")
      ->type_name("PATTERN");
  command
      .add_option("--announce", arguments.announced_files,
                  "vehicle files of boats that announce themselves to the daemons, under the ids "
                  "that their telemetry has")
      ->type_name("FILE")
      ->check(CLI::ExistingFile.description(""));
  command
      .add_option("--channel", arguments.channels,
                  "take these channels alone, gnss, heading or thrusters (default: all)")
      ->type_name("CHANNEL")
      ->check(CLI::IsMember({"gnss", "heading", "thrusters"}).description(""));
  const auto channel = [&](const std::string& name, std::optional<int>& value,
                           const std::string& help) {
    command.add_option(name, value, help)
        ->type_name("N")
        ->check(CLI::Range(1, kMavlinkOutputs).description(""));
  };
  channel("--port-channel", arguments.source.port_channel,
          "the output that drives the port thruster, [1, 16] (default: the one whose "
          "SERVOn_FUNCTION is 73; 1 of MAVROS)");
  channel("--starboard-channel", arguments.source.starboard_channel,
          "the same for starboard (default: SERVOn_FUNCTION 74; 3 of MAVROS)");
  command.add_option("--domain", arguments.domain, "DDS domain")
      ->envname("TELLTALE_DOMAIN")
      ->check(CLI::Range(0u, kHighestDomain))
      ->capture_default_str();
}

}  // namespace

void AddBridge(CLI::App& telltale) {
  const auto arguments = std::make_shared<BridgeArguments>();
  CLI::App& command = *telltale.add_subcommand(
      "bridge", "Publishes what running boats say over MAVLink or ROS 2 as telemetry");
  CLI::App& sources = *command.add_option_group("from", "running autopilots, or topics of ROS 2");
  CLI::Option* const mavlink = AddMavlink(sources, *arguments);
  CLI::Option* const ros2 =
      sources.add_flag("--ros2", arguments->from_ros2, "topics of ROS 2 on DDS; needs no ROS");
  sources.require_option(1);
  AddMavlinkOptions(command, *arguments, mavlink);
  AddRos2Options(command, *arguments, ros2);
  AddSharedOptions(command, *arguments);
  command.footer(
      "Runs until Ctrl-C or SIGTERM, then says what went through. Lost links are opened again.\n"
      "Models and quality of the boats go back to ROS 2: /telltale/NAME/model, /diagnostics.\n"
      "Examples: telltale bridge --mavlink udp:0.0.0.0:14550 --vehicle-id boat-{system}\n"
      "          telltale bridge --ros2 --namespace /fleet/{vehicle}");
  command.callback(
      [arguments] { arguments->from_ros2 ? FromRos2(*arguments) : FromMavlink(*arguments); });
}

}  // namespace telltale
