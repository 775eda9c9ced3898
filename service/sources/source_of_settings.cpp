#include "telltale/service/sources/source_of_settings.hpp"

#include <utility>

#include "telltale/client/bridge/mavlink_address.hpp"
#include "telltale/client/bridge/mavlink_source.hpp"
#include "telltale/client/bridge/ros2_source.hpp"

namespace telltale {
namespace {

MavlinkBridgeOptions MavlinkOptionsOf(const SourceSettings& settings) {
  MavlinkBridgeOptions options;
  if (!settings.vehicle_id.empty()) options.vehicle_id = settings.vehicle_id;
  options.systems = settings.mavlink->system_ids;
  options.port_channel = settings.port_channel;
  options.starboard_channel = settings.starboard_channel;
  options.channels = settings.channels;
  options.rate_hz = settings.mavlink->rate_hz;
  options.listen_only = settings.mavlink->listen_only;
  return options;
}

Ros2SourceOptions Ros2OptionsOf(const SourceSettings& settings) {
  Ros2SourceOptions options;
  if (!settings.vehicle_id.empty()) options.bridge.vehicle_id = settings.vehicle_id;
  options.bridge.name_space = settings.ros2->name_space;
  options.bridge.source.port_channel = settings.port_channel;
  options.bridge.source.starboard_channel = settings.starboard_channel;
  options.bridge.source.mapping = settings.ros2->mapping;
  options.bridge.channels = settings.channels;
  options.domain = settings.ros2->domain;
  options.publish = !settings.ros2->telemetry_only;
  return options;
}

}  // namespace

std::optional<CodecError> SourceFault(const SourceSettings& settings) {
  if (settings.ros2) {
    const auto fault = Ros2OptionsOf(settings).bridge.Fault();
    if (!fault) return std::nullopt;
    return CodecError{"ros2", '"' + Ros2OptionsOf(settings).bridge.Namespace() + '"', *fault};
  }
  const std::string& address = settings.mavlink->address;
  if (const auto parsed = ParseMavlinkAddress(address); !parsed) {
    return CodecError{"mavlink.address", '"' + address + '"', parsed.error()};
  }
  const MavlinkBridgeOptions options = MavlinkOptionsOf(settings);
  if (const auto fault = options.Fault()) {
    return CodecError{"vehicle_id", '"' + options.vehicle_id + '"', *fault};
  }
  return std::nullopt;
}

std::string SourceName(const SourceSettings& settings) {
  if (settings.mavlink) return "mavlink " + settings.mavlink->address;
  return "ros2 " + Ros2OptionsOf(settings).bridge.Namespace();
}

std::unique_ptr<LiveSource> MakeSource(const SourceSettings& settings,
                                       const Participant& participant,
                                       const LiveSource::Report& report) {
  if (settings.ros2) {
    return std::make_unique<Ros2Source>(participant, Ros2OptionsOf(settings), report);
  }
  return std::make_unique<MavlinkSource>(participant,
                                         *ParseMavlinkAddress(settings.mavlink->address),
                                         MavlinkOptionsOf(settings), report);
}

}  // namespace telltale
