#include "telltale/client/recording/source_log.hpp"

#include <utility>

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
  return OptionOutOfRange("starboard_channel", starboard_channel, 1, 16);
}

std::optional<Refusal> SourceLog::Lacks() const {
  const std::string read = " (" + summary + ")";
  if (gnss.empty()) {
    return Refusal{"gnss", "no position with a fix" + read, "record GNSS positions with a 3D fix"};
  }
  if (heading.empty()) {
    return Refusal{"heading", "no heading" + read, "record the attitude or compass heading"};
  }
  if (thrusters.empty()) {
    return Refusal{"thrusters", "no outputs of two known thrusters" + read,
                   "record the servo outputs; where the file does not name the channels of the "
                   "thrusters, give --port-channel and --starboard-channel, or say by --map what "
                   "holds their commands"};
  }
  return std::nullopt;
}

Result<SourceLog> Complete(SourceLog log, const std::filesystem::path& file) {
  auto refusal = log.Lacks();
  if (!refusal) return log;
  refusal->subject = file.string() + " " + refusal->subject;
  return tl::unexpected(*std::move(refusal));
}

}  // namespace telltale
