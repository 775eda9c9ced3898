#include "telltale/client/recording/servo_outputs.hpp"

#include <algorithm>
#include <array>
#include <sstream>

namespace telltale {
namespace {

constexpr int kLastServo = 32;
constexpr double kShortestPulseUs = 500.0;
constexpr double kLongestPulseUs = 2500.0;

std::string ParameterName(std::string_view prefix, int channel, std::string_view tail) {
  return std::string(prefix) + std::to_string(channel) + std::string(tail);
}

std::optional<double> Find(const AutopilotParameters& parameters, const std::string& name) {
  const auto found = parameters.find(name);
  return found == parameters.end() ? std::nullopt : std::optional(found->second);
}

/// Firmware before Rover 3.2 kept output settings under RCn_, where newer firmware keeps its
/// inputs.
std::string_view OutputPrefix(const AutopilotParameters& parameters) {
  const bool has_servos =
      std::any_of(parameters.begin(), parameters.end(),
                  [](const auto& parameter) { return parameter.first.starts_with("SERVO"); });
  return has_servos ? "SERVO" : "RC";
}

/// SERVOn_REVERSED is 1 on a reversed channel; its forerunner RCn_REV is -1.
bool IsReversed(const AutopilotParameters& parameters, std::string_view prefix, int channel) {
  return Find(parameters, ParameterName(prefix, channel, "_REVERSED")).value_or(0.0) > 0.0 ||
         Find(parameters, ParameterName(prefix, channel, "_REV")).value_or(1.0) < 0.0;
}

}  // namespace

std::optional<Refusal> SameChannel(std::optional<int> port, std::optional<int> starboard) {
  if (!port || port != starboard) return std::nullopt;
  return Refusal{"starboard_channel",
                 "output " + std::to_string(*port) + " stands for both thrusters",
                 "give the output of each thruster"};
}

bool IsOutputParameter(std::string_view name) {
  std::size_t at = name.starts_with("SERVO") ? 5 : name.starts_with("RC") ? 2 : 0;
  const std::size_t digits = at;
  while (at < name.size() && name[at] >= '0' && name[at] <= '9') ++at;
  if (digits == 0 || at == digits || at - digits > 2) return false;
  const std::string_view tail = name.substr(at);
  return tail == "_FUNCTION" || tail == "_MIN" || tail == "_TRIM" || tail == "_MAX" ||
         tail == "_REVERSED" || tail == "_REV";
}

std::optional<int> ChannelWithFunction(const AutopilotParameters& parameters, int function) {
  const std::string_view prefix = OutputPrefix(parameters);
  for (int channel = 1; channel <= kLastServo; ++channel) {
    if (Find(parameters, ParameterName(prefix, channel, "_FUNCTION")) == function) return channel;
  }
  return std::nullopt;
}

ThrusterOutput OutputOn(const AutopilotParameters& parameters, int channel) {
  ThrusterOutput output;
  output.channel = channel;
  const std::string_view prefix = OutputPrefix(parameters);
  std::array<double, 3> us{};
  const std::array<std::string_view, 3> tails = {"_MIN", "_TRIM", "_MAX"};
  for (std::size_t i = 0; i < tails.size(); ++i) {
    const std::string name = ParameterName(prefix, channel, tails[i]);
    const std::optional<double> value = Find(parameters, name);
    if (!value) {
      output.range_fault = "no " + name + " in the log";
      return output;
    }
    us[i] = *value;
  }
  const auto [min, trim, max] = us;
  if (!(kShortestPulseUs <= min && min < trim && trim < max && max <= kLongestPulseUs)) {
    std::ostringstream fault;
    fault << ParameterName(prefix, channel, "_MIN, _TRIM, _MAX") << " = " << min << ", " << trim
          << ", " << max << ": must ascend within [500, 2500]";
    output.range_fault = fault.str();
    return output;
  }
  output.range = IsReversed(parameters, prefix, channel) ? PwmChannel{trim, min, max}
                                                         : PwmChannel{trim, max, min};
  return output;
}

}  // namespace telltale
