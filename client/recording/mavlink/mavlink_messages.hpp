#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "telltale/client/recording/mavlink/mavlink_frames.hpp"

namespace telltale {

// The messages of MAVLink's common dialect that say where a boat is, where it heads and what its
// thrusters are told. Field names and units are the dialect's. Source: MAVLink, common.xml.

inline constexpr std::uint8_t kMavlinkAutopilot = 1;  ///< MAV_COMP_ID_AUTOPILOT1

struct MavlinkHeartbeat {
  static constexpr std::uint32_t kId = 0;
  std::uint8_t autopilot = 0;  ///< MAV_AUTOPILOT; 8: this component is none
};

struct MavlinkGpsRawInt {
  static constexpr std::uint32_t kId = 24;
  std::uint64_t time_us = 0;  ///< since boot, or since 1970
  double latitude_deg = 0.0;
  double longitude_deg = 0.0;
  std::uint8_t fix_type = 0;

  bool HasFix() const { return fix_type >= 3; }  ///< a three-dimensional one
};

struct MavlinkGlobalPositionInt {
  static constexpr std::uint32_t kId = 33;
  std::uint32_t time_boot_ms = 0;
  double latitude_deg = 0.0;
  double longitude_deg = 0.0;
  std::optional<double> heading_deg;  ///< nothing where the autopilot does not know it
};

struct MavlinkAttitude {
  static constexpr std::uint32_t kId = 30;
  std::uint32_t time_boot_ms = 0;
  float yaw_rad = 0.0F;  ///< clockwise from true north
};

inline constexpr int kMavlinkOutputs = 16;
using MavlinkPulses = std::array<std::uint16_t, kMavlinkOutputs>;

struct MavlinkServoOutputRaw {
  static constexpr std::uint32_t kId = 36;
  std::uint32_t time_us = 0;  ///< since boot; begins anew every 71.6 minutes
  std::uint8_t bank = 0;      ///< outputs 1 to 16 are bank 0
  MavlinkPulses pulse_us{};   ///< by output; 0: not there
};

struct MavlinkParamValue {
  static constexpr std::uint32_t kId = 22;
  std::string name;
  float value = 0.0F;
};

struct MavlinkSystemTime {
  static constexpr std::uint32_t kId = 2;
  std::uint64_t unix_us = 0;  ///< 0: not known yet
  std::uint32_t boot_ms = 0;
};

/// An autopilot's answer to a COMMAND_LONG.
struct MavlinkCommandAck {
  static constexpr std::uint32_t kId = 77;
  std::uint16_t command = 0;
  std::uint8_t result = 0;         ///< MAV_RESULT; 0: accepted
  std::uint8_t target_system = 0;  ///< who had asked; 0: not said
};

/// What a ground station asks an autopilot for: COMMAND_LONG and PARAM_REQUEST_READ.
inline constexpr std::uint32_t kMavlinkCommandLong = 76;
inline constexpr std::uint32_t kMavlinkParamRequestRead = 20;

/// Whether a time of GPS_RAW_INT is on the UNIX clock: no autopilot runs for 30 years.
constexpr bool IsMavlinkUnixTime(double time_s) {
  return time_s > 1e9;
}

/// CRC_EXTRA of the messages above; nothing for any other.
std::optional<std::uint8_t> MavlinkCrcExtra(std::uint32_t message);

/// The fields of a frame's payload, which counts as filled up by zeros.
/// Requires: the frame is of that message.
MavlinkHeartbeat HeartbeatOf(const MavlinkFrame& frame);
MavlinkGpsRawInt GpsRawIntOf(const MavlinkFrame& frame);
MavlinkGlobalPositionInt GlobalPositionIntOf(const MavlinkFrame& frame);
MavlinkAttitude AttitudeOf(const MavlinkFrame& frame);
MavlinkServoOutputRaw ServoOutputRawOf(const MavlinkFrame& frame);
MavlinkParamValue ParamValueOf(const MavlinkFrame& frame);
MavlinkSystemTime SystemTimeOf(const MavlinkFrame& frame);
MavlinkCommandAck CommandAckOf(const MavlinkFrame& frame);

}  // namespace telltale
