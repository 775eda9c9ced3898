#include "telltale/client/recording/source_log.hpp"

namespace telltale {
namespace {

std::optional<Refusal> OptionOutOfRange(const char* field, std::optional<int> value, int low,
                                        int high) {
  if (!value || (low <= *value && *value <= high)) return std::nullopt;
  const std::string range = "[" + std::to_string(low) + ", " + std::to_string(high) + "]";
  return Refusal{field, std::to_string(*value) + " is outside " + range,
                 std::string("give ") + field + " a value in " + range};
}

}  // namespace

std::optional<Refusal> SourceOptions::Validate() const {
  if (auto refusal = OptionOutOfRange("gps_instance", gps_instance, 0, 255)) return refusal;
  if (auto refusal = OptionOutOfRange("system_id", system_id, 1, 255)) return refusal;
  if (auto refusal = OptionOutOfRange("port_channel", port_channel, 1, 16)) return refusal;
  if (auto refusal = OptionOutOfRange("starboard_channel", starboard_channel, 1, 16)) {
    return refusal;
  }
  return SameChannel(port_channel, starboard_channel);
}

std::vector<Refusal> SourceLog::Lacks() const {
  std::vector<Refusal> lacks;
  if (gnss.empty()) {
    lacks.push_back({"gnss", "no position with a fix", "record GNSS positions with a 3D fix"});
  }
  if (heading.empty()) {
    lacks.push_back({"heading", "no heading", "record the attitude or compass heading"});
  }
  if (thrusters.empty()) {
    lacks.push_back(shared_output.value_or(
        Refusal{"thrusters", "no outputs of two known thrusters",
                "record the servo outputs; where the file does not name the channels of the "
                "thrusters, give --port-channel and --starboard-channel, or say by --map what "
                "holds their commands"}));
  }
  return lacks;
}

}  // namespace telltale
