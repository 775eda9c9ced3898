#include "telltale/client/bridge/mavlink_requests.hpp"

#include <array>
#include <bit>
#include <cstddef>
#include <string>

#include "telltale/client/recording/mavlink/mavlink_messages.hpp"

namespace telltale {
namespace {

constexpr std::uint8_t kGroundStation = 6;
constexpr std::uint8_t kNoAutopilot = 8;
constexpr std::uint8_t kActive = 4;
constexpr std::uint8_t kVersion = 3;

void PutFloat(std::vector<std::uint8_t>& payload, std::size_t at, float value) {
  const auto bits = std::bit_cast<std::uint32_t>(value);
  for (std::size_t i = 0; i < 4; ++i) {
    payload[at + i] = static_cast<std::uint8_t>(bits >> (8 * i) & 0xFF);
  }
}

MavlinkRequest SetMessageInterval(std::uint8_t system, std::uint8_t component,
                                  std::uint32_t message, double rate_hz) {
  MavlinkRequest request{kMavlinkCommandLong, std::vector<std::uint8_t>(33)};
  PutFloat(request.payload, 0, static_cast<float>(message));
  PutFloat(request.payload, 4, static_cast<float>(1e6 / rate_hz));  // interval, us
  request.payload[28] = kMavlinkSetMessageInterval & 0xFF;
  request.payload[29] = kMavlinkSetMessageInterval >> 8;
  request.payload[30] = system;
  request.payload[31] = component;
  return request;
}

}  // namespace

std::string MavlinkRefusalName(std::uint8_t result) {
  switch (result) {
    case 0: return "";
    case 1: return "TEMPORARILY_REJECTED";
    case 2: return "DENIED";
    case 3: return "UNSUPPORTED";
    case 4: return "FAILED";
    case 5: return "";  // in progress
    case 6: return "CANCELLED";
    default: return std::to_string(result);
  }
}

MavlinkRequest GroundStationHeartbeat() {
  return {MavlinkHeartbeat::kId, {0, 0, 0, 0, kGroundStation, kNoAutopilot, 0, kActive, kVersion}};
}

std::vector<MavlinkRequest> MessageIntervalRequests(std::uint8_t system, std::uint8_t component,
                                                    double rate_hz) {
  constexpr std::array kMessages = {MavlinkGpsRawInt::kId, MavlinkGlobalPositionInt::kId,
                                    MavlinkAttitude::kId, MavlinkServoOutputRaw::kId};
  std::vector<MavlinkRequest> requests;
  for (const std::uint32_t message : kMessages) {
    requests.push_back(SetMessageInterval(system, component, message, rate_hz));
  }
  requests.push_back(SetMessageInterval(system, component, MavlinkSystemTime::kId, 1.0));
  return requests;
}

std::vector<MavlinkRequest> OutputFunctionRequests(std::uint8_t system, std::uint8_t component) {
  std::vector<MavlinkRequest> requests;
  for (int output = 1; output <= kMavlinkOutputs; ++output) {
    MavlinkRequest request{kMavlinkParamRequestRead, std::vector<std::uint8_t>(20)};
    request.payload[0] = request.payload[1] = 0xFF;  // index -1: by name
    request.payload[2] = system;
    request.payload[3] = component;
    const std::string name = "SERVO" + std::to_string(output) + "_FUNCTION";
    for (std::size_t i = 0; i < name.size() && i < 16; ++i) {
      request.payload[4 + i] = static_cast<std::uint8_t>(name[i]);
    }
    requests.push_back(std::move(request));
  }
  return requests;
}

}  // namespace telltale
