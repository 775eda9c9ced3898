#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "telltale/core/base/result.hpp"
#include "telltale/core/vessel/propellers.hpp"

namespace telltale {

/// One thruster's output: its channel and, when the autopilot's parameters say it soundly, its
/// range.
struct ThrusterOutput {
  int channel = 0;
  std::optional<PwmChannel> range;  ///< from SERVOn_MIN, TRIM, MAX, REVERSED
  std::string range_fault;          ///< why there is no range
};

/// An autopilot's parameters by name.
using AutopilotParameters = std::map<std::string, double, std::less<>>;

inline constexpr int kThrottleLeft = 73;   ///< SERVOn_FUNCTION of the port thruster
inline constexpr int kThrottleRight = 74;  ///< of the starboard thruster

/// Why two channels, named by a user or else by the file, cannot be those of two thrusters: they
/// are one.
std::optional<Refusal> SameChannel(std::optional<int> port, std::optional<int> starboard);

/// Whether a parameter is about an output: "SERVO12_TRIM", or "RC1_REV" of older firmware.
bool IsOutputParameter(std::string_view name);

/// The channel that has this SERVOn_FUNCTION, counted from 1; the first of several.
std::optional<int> ChannelWithFunction(const AutopilotParameters& parameters, int function);

/// What the parameters say of a channel. Source: ArduPilot, SERVOn_MIN, SERVOn_TRIM, SERVOn_MAX,
/// SERVOn_REVERSED; before Rover 3.2 RCn_MIN, RCn_TRIM, RCn_MAX, RCn_REV.
ThrusterOutput OutputOn(const AutopilotParameters& parameters, int channel);

}  // namespace telltale
