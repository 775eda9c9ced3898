#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace telltale {

/// One message to an autopilot, without a place in a sequence yet.
struct MavlinkRequest {
  std::uint32_t message = 0;
  std::vector<std::uint8_t> payload;
};

/// As whom the bridge speaks. An autopilot takes heartbeats of system 255 for its operator's ground
/// station and holds its failsafe back as long as they come: the bridge must not be that system.
inline constexpr std::uint8_t kBridgeSystem = 254;
inline constexpr std::uint8_t kBridgeComponent = 191;  ///< MAV_COMP_ID_ONBOARD_COMPUTER

inline constexpr std::uint16_t kMavlinkSetMessageInterval = 511;  ///< MAV_CMD

/// "DENIED" of MAV_RESULT 2 and the like, the number where it is none that is known; empty where
/// the command is accepted or still under way. Source: MAVLink, common.xml.
std::string MavlinkRefusalName(std::uint8_t result);

/// HEARTBEAT of a ground station (MAV_TYPE_GCS) that is no autopilot.
MavlinkRequest GroundStationHeartbeat();

/// MAV_CMD_SET_MESSAGE_INTERVAL for each message that the bridge takes: `rate_hz` for
/// GPS_RAW_INT, GLOBAL_POSITION_INT, ATTITUDE and SERVO_OUTPUT_RAW, 1 Hz for SYSTEM_TIME.
/// Requires: rate_hz > 0. Source: MAVLink, common.xml.
std::vector<MavlinkRequest> MessageIntervalRequests(std::uint8_t system, std::uint8_t component,
                                                    double rate_hz);

/// PARAM_REQUEST_READ of SERVO1_FUNCTION to SERVO16_FUNCTION.
std::vector<MavlinkRequest> OutputFunctionRequests(std::uint8_t system, std::uint8_t component);

}  // namespace telltale
