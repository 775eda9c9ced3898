#include "telltale/client/recording/mavlink/mavlink_messages.hpp"

#include <algorithm>
#include <array>
#include <bit>

namespace telltale {
namespace {

/// Little-endian fields of a payload; beyond its end all bytes are zero.
class Payload {
 public:
  explicit Payload(const MavlinkFrame& frame) {
    std::copy_n(frame.payload.begin(), std::min(frame.payload.size(), bytes_.size()),
                bytes_.begin());
  }

  std::uint8_t U8(std::size_t at) const { return bytes_[at]; }
  std::uint16_t U16(std::size_t at) const {
    return static_cast<std::uint16_t>(U8(at) | U8(at + 1) << 8);
  }
  std::uint32_t U32(std::size_t at) const {
    return static_cast<std::uint32_t>(U16(at)) | static_cast<std::uint32_t>(U16(at + 2)) << 16;
  }
  std::uint64_t U64(std::size_t at) const {
    return static_cast<std::uint64_t>(U32(at)) | static_cast<std::uint64_t>(U32(at + 4)) << 32;
  }
  float F32(std::size_t at) const { return std::bit_cast<float>(U32(at)); }
  double Degrees(std::size_t at) const { return static_cast<std::int32_t>(U32(at)) / 1e7; }

 private:
  static constexpr std::size_t kLongest = 64;  // no field that is read lies further on

  std::array<std::uint8_t, kLongest> bytes_{};
};

constexpr std::uint16_t kHeadingUnknown = 65535;

}  // namespace

std::optional<std::uint8_t> MavlinkCrcExtra(std::uint32_t message) {
  switch (message) {
    case MavlinkHeartbeat::kId: return 50;
    case MavlinkSystemTime::kId: return 137;
    case MavlinkParamValue::kId: return 220;
    case MavlinkGpsRawInt::kId: return 24;
    case MavlinkAttitude::kId: return 39;
    case MavlinkGlobalPositionInt::kId: return 104;
    case MavlinkServoOutputRaw::kId: return 222;
    case kMavlinkParamRequestRead: return 214;
    case kMavlinkCommandLong: return 152;
    case MavlinkCommandAck::kId: return 143;
    default: return std::nullopt;
  }
}

MavlinkHeartbeat HeartbeatOf(const MavlinkFrame& frame) {
  return {Payload(frame).U8(5)};
}

MavlinkGpsRawInt GpsRawIntOf(const MavlinkFrame& frame) {
  const Payload payload(frame);
  return {payload.U64(0), payload.Degrees(8), payload.Degrees(12), payload.U8(28)};
}

MavlinkGlobalPositionInt GlobalPositionIntOf(const MavlinkFrame& frame) {
  const Payload payload(frame);
  MavlinkGlobalPositionInt position{payload.U32(0), payload.Degrees(4), payload.Degrees(8),
                                    std::nullopt};
  const std::uint16_t heading = payload.U16(26);
  if (heading != kHeadingUnknown) position.heading_deg = 0.01 * heading;
  return position;
}

MavlinkAttitude AttitudeOf(const MavlinkFrame& frame) {
  const Payload payload(frame);
  return {payload.U32(0), payload.F32(12)};
}

MavlinkServoOutputRaw ServoOutputRawOf(const MavlinkFrame& frame) {
  const Payload payload(frame);
  MavlinkServoOutputRaw output;
  output.time_us = payload.U32(0);
  for (std::size_t i = 0; i < 8; ++i) {
    output.pulse_us[i] = payload.U16(4 + 2 * i);
    output.pulse_us[8 + i] = payload.U16(21 + 2 * i);
  }
  output.bank = payload.U8(20);
  return output;
}

MavlinkParamValue ParamValueOf(const MavlinkFrame& frame) {
  const Payload payload(frame);
  MavlinkParamValue parameter;
  parameter.value = payload.F32(0);
  for (std::size_t i = 0; i < 16 && payload.U8(8 + i) != 0; ++i) {
    parameter.name.push_back(static_cast<char>(payload.U8(8 + i)));
  }
  return parameter;
}

MavlinkSystemTime SystemTimeOf(const MavlinkFrame& frame) {
  const Payload payload(frame);
  return {payload.U64(0), payload.U32(8)};
}

MavlinkCommandAck CommandAckOf(const MavlinkFrame& frame) {
  const Payload payload(frame);
  return {payload.U16(0), payload.U8(2), payload.U8(8)};
}

}  // namespace telltale
