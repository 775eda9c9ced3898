#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "telltale/client/bridge/mavlink_address.hpp"
#include "telltale/client/bridge/mavlink_bridge.hpp"
#include "telltale/client/bridge/ros2_source.hpp"
#include "telltale/core/vessel/vehicle.hpp"

namespace telltale {

/// Publish a link's autopilots, or topics of ROS 2, as telemetry until SIGINT or SIGTERM, then
/// print what went through. The `announced` vehicles announce themselves as long. Throw
/// std::runtime_error where the link cannot be opened.
void BridgeMavlink(const MavlinkAddress& address, const MavlinkBridgeOptions& options,
                   const std::vector<Vehicle>& announced, std::uint32_t domain);
void BridgeRos2(const Ros2SourceOptions& options, const std::vector<Vehicle>& announced,
                std::uint32_t domain);

}  // namespace telltale
