#include "telltale/client/recording/mavlink/mavlink_json.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include <simdjson.h>

namespace telltale {
namespace {

using Json = simdjson::dom::element;

constexpr std::array<std::string_view, 6> kOfUse = {"GPS_RAW_INT", "GLOBAL_POSITION_INT",
                                                    "ATTITUDE",    "SERVO_OUTPUT_RAW",
                                                    "PARAM_VALUE", "SYSTEM_TIME"};

/// An integer field. Throws where it is no number or not of that type's range.
template <class Integer>
Integer IntegerOf(const Json& value) {
  std::uint64_t exact = 0;
  const bool is_exact = value.get(exact) == simdjson::SUCCESS;
  const double number = is_exact ? static_cast<double>(exact) : double(value);
  const bool is_in_range = 0.0 <= number && number < std::ldexp(1.0, 8 * sizeof(Integer));
  if (!is_in_range) throw std::out_of_range("a field of a message");
  return is_exact ? static_cast<Integer>(exact) : static_cast<Integer>(number);
}

/// A number of MAVLink's single precision; one that is too large becomes infinite.
float FloatOf(const Json& value) {
  const double number = value;
  const double largest = std::numeric_limits<float>::max();
  if (std::abs(number) > largest) return number > 0.0 ? INFINITY : -INFINITY;
  return static_cast<float>(number);
}

double DegreesOf(const Json& value) {
  return double(value) / 1e7;
}

std::uint8_t FixTypeOf(const Json& value) {
  if (value.is_number()) return IntegerOf<std::uint8_t>(value);
  std::string_view name;
  const bool is_named =
      value["type"].get(name) == simdjson::SUCCESS || value.get(name) == simdjson::SUCCESS;
  const bool has_none = !is_named || name.empty() || name == "GPS_FIX_TYPE_NO_GPS" ||
                        name == "GPS_FIX_TYPE_NO_FIX" || name == "GPS_FIX_TYPE_2D_FIX";
  return has_none ? 0 : 3;
}

/// A text, or an array of its characters or of their codes; zeros fill it up.
std::string ParameterNameOf(const Json& value) {
  std::string name;
  std::string_view text;
  simdjson::dom::array characters;
  if (value.get(text) == simdjson::SUCCESS) {
    name = text;
  } else if (value.get(characters) == simdjson::SUCCESS) {
    for (const Json character : characters) {
      std::uint64_t code = 0;
      if (character.get(text) == simdjson::SUCCESS) name += text;
      if (character.get(code) == simdjson::SUCCESS) name.push_back(static_cast<char>(code));
    }
  }
  while (!name.empty() && name.back() == '\0') name.pop_back();
  return name;
}

MavlinkGpsRawInt GpsRawIntOf(const Json& message) {
  return {IntegerOf<std::uint64_t>(message["time_usec"]), DegreesOf(message["lat"]),
          DegreesOf(message["lon"]), FixTypeOf(message["fix_type"])};
}

MavlinkGlobalPositionInt GlobalPositionIntOf(const Json& message) {
  MavlinkGlobalPositionInt position{IntegerOf<std::uint32_t>(message["time_boot_ms"]),
                                    DegreesOf(message["lat"]), DegreesOf(message["lon"]),
                                    std::nullopt};
  const double heading = message["hdg"];
  if (heading < 36000.5) position.heading_deg = 0.01 * heading;
  return position;
}

/// The place of "servo3_raw" among the outputs, from 0.
std::optional<std::size_t> OutputNamed(std::string_view field) {
  if (!field.starts_with("servo") || !field.ends_with("_raw")) return std::nullopt;
  const std::string_view number = field.substr(5, field.size() - 9);
  std::size_t output = 0;
  const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), output);
  const bool is_number = error == std::errc() && end == number.data() + number.size();
  return is_number && 1 <= output && output <= kMavlinkOutputs ? std::optional(output - 1)
                                                               : std::nullopt;
}

MavlinkServoOutputRaw ServoOutputRawOf(const Json& message) {
  MavlinkServoOutputRaw output;
  output.time_us = IntegerOf<std::uint32_t>(message["time_usec"]);
  for (const auto& [field, value] : simdjson::dom::object(message)) {
    if (field == "port") output.bank = IntegerOf<std::uint8_t>(value);
    if (const auto i = OutputNamed(field)) output.pulse_us[*i] = IntegerOf<std::uint16_t>(value);
  }
  return output;
}

int ComponentOf(const Json& header) {
  Json component;
  const bool is_said = header["component_id"].get(component) == simdjson::SUCCESS;
  return is_said ? IntegerOf<std::uint8_t>(component) : kMavlinkAutopilot;
}

void TakeMessage(const MavlinkSender& sender, const Json& message, MavlinkRecording& recording) {
  const std::string_view type = message["type"];
  if (type == "GPS_RAW_INT") {
    recording.Take(sender, GpsRawIntOf(message));
  } else if (type == "GLOBAL_POSITION_INT") {
    recording.Take(sender, GlobalPositionIntOf(message));
  } else if (type == "ATTITUDE") {
    recording.Take(sender, MavlinkAttitude{IntegerOf<std::uint32_t>(message["time_boot_ms"]),
                                           FloatOf(message["yaw"])});
  } else if (type == "SERVO_OUTPUT_RAW") {
    recording.Take(sender, ServoOutputRawOf(message));
  } else if (type == "PARAM_VALUE") {
    recording.Take(sender, MavlinkParamValue{ParameterNameOf(message["param_id"]),
                                             FloatOf(message["param_value"])});
  } else if (type == "SYSTEM_TIME") {
    recording.Take(sender, MavlinkSystemTime{IntegerOf<std::uint64_t>(message["time_unix_usec"]),
                                             IntegerOf<std::uint32_t>(message["time_boot_ms"])});
  }
}

}  // namespace

bool IsMavlinkMessageOfUse(std::string_view type) {
  return std::find(kOfUse.begin(), kOfUse.end(), type) != kOfUse.end();
}

struct MavlinkJson::Parser {
  simdjson::dom::parser parser;
  std::vector<std::uint8_t> padded;  ///< the parser reads on behind a text
};

MavlinkJson::MavlinkJson() : parser_(std::make_unique<Parser>()) {}
MavlinkJson::~MavlinkJson() = default;

bool MavlinkJson::Take(std::span<const std::uint8_t> json, MavlinkRecording& recording) {
  auto& padded = parser_->padded;
  padded.resize(std::max(padded.size(), json.size() + simdjson::SIMDJSON_PADDING));
  std::copy(json.begin(), json.end(), padded.begin());
  try {
    const Json root = parser_->parser.parse(padded.data(), json.size(), false);
    const Json header = root["header"];
    TakeMessage({IntegerOf<std::uint8_t>(header["system_id"]), ComponentOf(header)},
                root["message"], recording);
  } catch (const std::exception&) {  // of the parser, or out of range
    return false;
  }
  return true;
}

}  // namespace telltale
