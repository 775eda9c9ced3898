#include "telltale/client/recording/mavlink/mavlink_recording.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "telltale/client/recording/block_reader.hpp"
#include "telltale/client/recording/further_part.hpp"
#include "telltale/client/recording/rate_warning.hpp"
#include "telltale/core/base/degrees.hpp"

namespace telltale {
namespace {

constexpr double kWrapUs = 4294967296.0;

/// What raises the rate of a message.
std::string AskFor(const char* parameter, const char* message) {
  return std::string("set ") + parameter +
         " to 10 (SR1_, SR2_ of another port), or ask for message " + message +
         " by MAV_CMD_SET_MESSAGE_INTERVAL";
}

std::string AndCount(std::uint64_t count, const char* what) {
  return count > 0 ? "; " + std::to_string(count) + ' ' + what : std::string();
}

}  // namespace

std::optional<int> ThrusterChannel(std::optional<int> asked, const AutopilotParameters& parameters,
                                   int function) {
  const auto channel = asked ? asked : ChannelWithFunction(parameters, function);
  return channel && *channel <= kMavlinkOutputs ? channel : std::nullopt;
}

double PulseOn(const MavlinkPulses& pulse_us, int channel) {
  return static_cast<double>(pulse_us[static_cast<std::size_t>(channel - 1)]);
}

std::size_t MavlinkRecording::Vehicle::Samples() const {
  return std::max(raw_fixes.Samples().size(), filtered_fixes.Samples().size()) +
         std::max(attitude.Samples().size(), filtered_heading.Samples().size()) +
         outputs.TimesS().size();
}

void MavlinkRecording::Take(const MavlinkFrame& frame) {
  const MavlinkSender sender(frame.system, frame.component);
  switch (frame.message) {
    case MavlinkGpsRawInt::kId: return Take(sender, GpsRawIntOf(frame));
    case MavlinkGlobalPositionInt::kId: return Take(sender, GlobalPositionIntOf(frame));
    case MavlinkAttitude::kId: return Take(sender, AttitudeOf(frame));
    case MavlinkServoOutputRaw::kId: return Take(sender, ServoOutputRawOf(frame));
    case MavlinkParamValue::kId: return Take(sender, ParamValueOf(frame));
    case MavlinkSystemTime::kId: return Take(sender, SystemTimeOf(frame));
    default: return;
  }
}

void MavlinkRecording::Take(const MavlinkSender& sender, const MavlinkGpsRawInt& message) {
  ++messages_;
  Vehicle& vehicle = VehicleOf(sender);
  if (!message.HasFix()) {
    ++vehicle.without_fix;
    return;
  }
  const double time_s = static_cast<double>(message.time_us) * 1e-6;
  const std::vector<GnssFix>& before = vehicle.raw_fixes.Samples();
  if (!before.empty() && before.back().time_s == time_s) {
    ++vehicle.repeated_fixes;
    return;
  }
  vehicle.filtered_fixes.Clear();
  vehicle.raw_fixes.Add({time_s, message.latitude_deg, message.longitude_deg});
}

void MavlinkRecording::Take(const MavlinkSender& sender, const MavlinkGlobalPositionInt& message) {
  ++messages_;
  Vehicle& vehicle = VehicleOf(sender);
  const double time_s = message.time_boot_ms * 1e-3;
  vehicle.boot_s = time_s;
  const bool has_position = message.latitude_deg != 0.0 || message.longitude_deg != 0.0;
  if (!has_position) ++vehicle.without_fix;
  if (has_position && vehicle.raw_fixes.Samples().empty()) {
    vehicle.filtered_fixes.Add({time_s, message.latitude_deg, message.longitude_deg});
  }
  if (message.heading_deg && vehicle.attitude.Samples().empty()) {
    vehicle.filtered_heading.Add({time_s, *message.heading_deg});
  }
}

void MavlinkRecording::Take(const MavlinkSender& sender, const MavlinkAttitude& message) {
  ++messages_;
  Vehicle& vehicle = VehicleOf(sender);
  vehicle.boot_s = message.time_boot_ms * 1e-3;
  vehicle.filtered_heading.Clear();
  vehicle.attitude.Add({*vehicle.boot_s, static_cast<double>(message.yaw_rad) * kDegreesPerRadian});
}

/// A counter of 32 bits begins anew every 71.6 minutes. The other messages' time since boot says
/// how often it has; without them it has where it goes back by more than half. One that goes back
/// by less was set back, which is for the checks of the window.
double MavlinkRecording::OutputTime(Vehicle& vehicle, std::uint32_t time_us) {
  if (vehicle.boot_s) {
    const double wraps = std::round((*vehicle.boot_s * 1e6 - time_us) / kWrapUs);
    vehicle.output_wraps = static_cast<std::uint64_t>(std::max(wraps, 0.0));
  } else if (time_us < vehicle.last_output_us && vehicle.last_output_us - time_us > kWrapUs / 2) {
    ++vehicle.output_wraps;
  }
  vehicle.last_output_us = time_us;
  return (static_cast<double>(vehicle.output_wraps) * kWrapUs + time_us) * 1e-6;
}

void MavlinkRecording::Take(const MavlinkSender& sender, const MavlinkServoOutputRaw& message) {
  ++messages_;
  if (message.bank != 0) return;
  Vehicle& vehicle = VehicleOf(sender);
  const double time_s = OutputTime(vehicle, message.time_us);
  std::array<float, kMavlinkOutputs> pulse_us{};
  std::copy(message.pulse_us.begin(), message.pulse_us.end(), pulse_us.begin());
  vehicle.outputs.Add(time_s, pulse_us);
}

void MavlinkRecording::Take(const MavlinkSender& sender, const MavlinkParamValue& message) {
  ++messages_;
  if (!IsOutputParameter(message.name) || !std::isfinite(message.value)) return;
  VehicleOf(sender).parameters[message.name] = static_cast<double>(message.value);
}

void MavlinkRecording::Take(const MavlinkSender& sender, const MavlinkSystemTime& message) {
  ++messages_;
  if (message.unix_us == 0) return;
  Vehicle& vehicle = VehicleOf(sender);
  if (vehicle.unix_less_boot_s) return;  // the first holds: a clock that is set later would jump
  vehicle.unix_less_boot_s = static_cast<double>(message.unix_us) * 1e-6 - message.boot_ms * 1e-3;
}

std::pair<const MavlinkSender, MavlinkRecording::Vehicle>* MavlinkRecording::Chosen(
    const SourceOptions& options) {
  const auto rank = [](const Vehicle& vehicle) {
    return std::pair(!vehicle.outputs.TimesS().empty(), vehicle.Samples());
  };
  std::pair<const MavlinkSender, Vehicle>* chosen = nullptr;
  for (auto& entry : vehicles_) {
    if (options.system_id && entry.first.system != *options.system_id) continue;
    if (chosen == nullptr || rank(chosen->second) < rank(entry.second)) chosen = &entry;
  }
  return chosen;
}

std::size_t MavlinkRecording::SystemsWithSamples() const {
  std::set<int> systems;
  for (const auto& [sender, vehicle] : vehicles_) {
    if (vehicle.Samples() > 0) systems.insert(sender.system);
  }
  return systems.size();
}

std::string MavlinkRecording::ChoosePositions(Vehicle& vehicle, SourceLog& log) {
  const bool are_raw = !vehicle.raw_fixes.Samples().empty();
  log.gnss = std::move(are_raw ? vehicle.raw_fixes : vehicle.filtered_fixes).Release();
  if (log.gnss.empty()) return {};
  const char* source = are_raw ? "GPS_RAW_INT" : "GLOBAL_POSITION_INT";
  log.summary += std::string("; positions from ") + source;
  if (vehicle.unix_less_boot_s) {
    for (GnssFix& fix : log.gnss) {
      if (IsMavlinkUnixTime(fix.time_s)) fix.time_s -= *vehicle.unix_less_boot_s;
    }
  }
  return RateWarning(source, log.gnss, kLowPositionHz,
                     are_raw ? AskFor("SR0_EXT_STAT", "24") : AskFor("SR0_POSITION", "33"));
}

std::string MavlinkRecording::ChooseHeadings(Vehicle& vehicle, SourceLog& log) {
  const bool are_attitudes = !vehicle.attitude.Samples().empty();
  log.heading = std::move(are_attitudes ? vehicle.attitude : vehicle.filtered_heading).Release();
  if (log.heading.empty()) return {};
  const char* source = are_attitudes ? "ATTITUDE" : "GLOBAL_POSITION_INT";
  log.summary += std::string("; heading from ") + source;
  return RateWarning(source, log.heading, kLowHeadingHz,
                     are_attitudes ? AskFor("SR0_EXTRA1", "30") : AskFor("SR0_POSITION", "33"));
}

std::string MavlinkRecording::ChooseOutputs(const Vehicle& vehicle, const SourceOptions& options,
                                            SourceLog& log) {
  const auto output = [&](std::optional<int> asked, int function) -> std::optional<ThrusterOutput> {
    const auto channel = ThrusterChannel(asked, vehicle.parameters, function);
    if (!channel) return std::nullopt;
    return OutputOn(vehicle.parameters, *channel);
  };
  std::string warning = RateWarning("SERVO_OUTPUT_RAW", vehicle.outputs.TimesS(), kLowOutputHz,
                                    AskFor("SR0_RC_CHAN", "36"));
  log.port = output(options.port_channel, kThrottleLeft);
  log.starboard = output(options.starboard_channel, kThrottleRight);
  if (vehicle.outputs.TimesS().empty()) return warning;
  if (!log.port || !log.starboard) {
    log.summary +=
        "; no PARAM_VALUE gives a SERVOn_FUNCTION 73 (ThrottleLeft) and 74 (ThrottleRight)";
    return warning;
  }
  log.shared_output = SameChannel(log.port->channel, log.starboard->channel);
  if (log.shared_output) return warning;
  log.summary += "; outputs " + std::to_string(log.port->channel) + " (port) and " +
                 std::to_string(log.starboard->channel) + " (starboard) of SERVO_OUTPUT_RAW";
  log.thrusters = vehicle.outputs.Of(log.port->channel, log.starboard->channel);
  return warning;
}

SourceLog MavlinkRecording::Finish(const SourceOptions& options) && {
  SourceLog log;
  log.summary = std::to_string(messages_) + " MAVLink messages of use";
  auto* chosen = Chosen(options);
  if (chosen == nullptr) {
    if (options.system_id)
      log.summary += "; none from system " + std::to_string(*options.system_id);
    return log;
  }
  auto& [sender, vehicle] = *chosen;
  log.summary += "; system " + std::to_string(sender.system);
  if (sender.component != kMavlinkAutopilot) {
    log.summary += ", component " + std::to_string(sender.component);
  }
  const std::size_t systems = SystemsWithSamples();
  if (systems > 1) log.summary += " of " + std::to_string(systems) + " (--system-id takes another)";
  const std::string of_positions = ChoosePositions(vehicle, log);
  const std::string of_headings = ChooseHeadings(vehicle, log);
  const std::string of_outputs = ChooseOutputs(vehicle, options, log);
  log.summary += of_outputs + of_headings + of_positions +
                 AndCount(vehicle.without_fix, "positions without a fix") +
                 AndCount(vehicle.repeated_fixes, "positions sent again") +
                 FurtherPart(memory_.Summary());
  return log;
}

Result<SourceLog> ReadMavlinkTelemetryLog(const std::filesystem::path& file,
                                          const SourceOptions& options) {
  if (auto refusal = options.Validate()) return tl::unexpected(*std::move(refusal));
  MavlinkRecording recording(options.memory_bytes);
  MavlinkTelemetryLog timed;
  MavlinkStream bare;
  std::optional<bool> is_bare;  // by how the file begins
  const auto read = ReadInBlocks(
      file,
      [&](std::span<const std::uint8_t> bytes, bool at_end) {
        if (!is_bare) is_bare = BeginsLikeMavlinkStream(bytes);
        if (*is_bare) {
          return bare.Consume(bytes, at_end,
                              [&](const MavlinkFrame& frame) { recording.Take(frame); });
        }
        return timed.Consume(bytes, at_end,
                             [&](auto, const MavlinkFrame& frame) { recording.Take(frame); });
      },
      options.progress);
  if (!read) return tl::unexpected(read.error());

  SourceLog log = std::move(recording).Finish(options);
  const MavlinkDamage& damage = *is_bare ? bare.Damage() : timed.Damage();
  log.summary += AndCount(damage.corrupt_frames, "messages with a wrong checksum") +
                 AndCount(damage.skipped_bytes, "bytes skipped") +
                 AndCount(damage.truncated_bytes, "bytes of a message cut off at the end");
  return log;
}

}  // namespace telltale
