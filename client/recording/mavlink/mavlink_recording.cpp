#include "telltale/client/recording/mavlink/mavlink_recording.hpp"

#include <algorithm>
#include <cmath>

#include "telltale/client/recording/block_reader.hpp"
#include "telltale/client/recording/rate_warning.hpp"
#include "telltale/core/base/degrees.hpp"

namespace telltale {
namespace {

constexpr std::uint32_t kHalfWrapUs = 1u << 31;

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
  return std::max(raw_fixes.size(), filtered_fixes.size()) +
         std::max(attitude.size(), filtered_heading.size()) + outputs.size();
}

void MavlinkRecording::Take(const MavlinkFrame& frame) {
  switch (frame.message) {
    case MavlinkGpsRawInt::kId: return Take(frame.system, GpsRawIntOf(frame));
    case MavlinkGlobalPositionInt::kId: return Take(frame.system, GlobalPositionIntOf(frame));
    case MavlinkAttitude::kId: return Take(frame.system, AttitudeOf(frame));
    case MavlinkServoOutputRaw::kId: return Take(frame.system, ServoOutputRawOf(frame));
    case MavlinkParamValue::kId: return Take(frame.system, ParamValueOf(frame));
    case MavlinkSystemTime::kId: return Take(frame.system, SystemTimeOf(frame));
    default: return;
  }
}

void MavlinkRecording::Take(int system, const MavlinkGpsRawInt& message) {
  ++messages_;
  Vehicle& vehicle = vehicles_[system];
  if (!message.HasFix()) {
    ++vehicle.without_fix;
    return;
  }
  const double time_s = static_cast<double>(message.time_us) * 1e-6;
  if (!vehicle.raw_fixes.empty() && vehicle.raw_fixes.back().time_s == time_s) {
    ++vehicle.repeated_fixes;
    return;
  }
  vehicle.raw_fixes.push_back({time_s, message.latitude_deg, message.longitude_deg});
}

void MavlinkRecording::Take(int system, const MavlinkGlobalPositionInt& message) {
  ++messages_;
  Vehicle& vehicle = vehicles_[system];
  const double time_s = message.time_boot_ms * 1e-3;
  vehicle.filtered_fixes.push_back({time_s, message.latitude_deg, message.longitude_deg});
  if (message.heading_deg) vehicle.filtered_heading.push_back({time_s, *message.heading_deg});
}

void MavlinkRecording::Take(int system, const MavlinkAttitude& message) {
  ++messages_;
  vehicles_[system].attitude.push_back(
      {message.time_boot_ms * 1e-3, static_cast<double>(message.yaw_rad) * kDegreesPerRadian});
}

void MavlinkRecording::Take(int system, const MavlinkServoOutputRaw& message) {
  ++messages_;
  if (message.bank != 0) return;
  Vehicle& vehicle = vehicles_[system];
  // A counter of 32 bits begins anew; one that went back by less was set back, which is for the
  // checks of the window.
  if (message.time_us < vehicle.last_output_us &&
      vehicle.last_output_us - message.time_us > kHalfWrapUs) {
    ++vehicle.output_wraps;
  }
  vehicle.last_output_us = message.time_us;
  const double time_s =
      (static_cast<double>(vehicle.output_wraps) * 4294967296.0 + message.time_us) * 1e-6;
  vehicle.outputs.push_back({time_s, message.pulse_us});
}

void MavlinkRecording::Take(int system, const MavlinkParamValue& message) {
  ++messages_;
  if (!IsOutputParameter(message.name) || !std::isfinite(message.value)) return;
  vehicles_[system].parameters[message.name] = static_cast<double>(message.value);
}

void MavlinkRecording::Take(int system, const MavlinkSystemTime& message) {
  ++messages_;
  if (message.unix_us == 0) return;
  Vehicle& vehicle = vehicles_[system];
  if (vehicle.unix_less_boot_s) return;  // the first holds: a clock that is set later would jump
  vehicle.unix_less_boot_s = static_cast<double>(message.unix_us) * 1e-6 - message.boot_ms * 1e-3;
}

const std::pair<const int, MavlinkRecording::Vehicle>* MavlinkRecording::Chosen(
    const SourceOptions& options) const {
  if (options.system_id) {
    const auto found = vehicles_.find(*options.system_id);
    return found == vehicles_.end() ? nullptr : &*found;
  }
  const auto most = std::max_element(
      vehicles_.begin(), vehicles_.end(),
      [](const auto& a, const auto& b) { return a.second.Samples() < b.second.Samples(); });
  return most == vehicles_.end() ? nullptr : &*most;
}

void MavlinkRecording::ChoosePositions(const Vehicle& vehicle, SourceLog& log) {
  log.gnss = vehicle.raw_fixes.empty() ? vehicle.filtered_fixes : vehicle.raw_fixes;
  if (log.gnss.empty()) return;
  log.summary += vehicle.raw_fixes.empty() ? "; positions from GLOBAL_POSITION_INT"
                                           : "; positions from GPS_RAW_INT";
  if (!vehicle.unix_less_boot_s) return;
  for (GnssFix& fix : log.gnss) {
    if (IsMavlinkUnixTime(fix.time_s)) fix.time_s -= *vehicle.unix_less_boot_s;
  }
}

void MavlinkRecording::ChooseHeadings(const Vehicle& vehicle, SourceLog& log) {
  log.heading = vehicle.attitude.empty() ? vehicle.filtered_heading : vehicle.attitude;
  if (log.heading.empty()) return;
  log.summary +=
      vehicle.attitude.empty() ? "; heading from GLOBAL_POSITION_INT" : "; heading from ATTITUDE";
}

void MavlinkRecording::ChooseOutputs(const Vehicle& vehicle, const SourceOptions& options,
                                     SourceLog& log) {
  const auto output = [&](std::optional<int> asked, int function) -> std::optional<ThrusterOutput> {
    const auto channel = ThrusterChannel(asked, vehicle.parameters, function);
    if (!channel) return std::nullopt;
    return OutputOn(vehicle.parameters, *channel);
  };
  if (vehicle.outputs.empty()) return;
  log.port = output(options.port_channel, kThrottleLeft);
  log.starboard = output(options.starboard_channel, kThrottleRight);
  if (!log.port || !log.starboard) {
    log.summary +=
        "; no PARAM_VALUE gives a SERVOn_FUNCTION 73 (ThrottleLeft) and 74 (ThrottleRight)";
    return;
  }
  log.summary += "; outputs " + std::to_string(log.port->channel) + " (port) and " +
                 std::to_string(log.starboard->channel) + " (starboard) of SERVO_OUTPUT_RAW";
  log.thrusters.reserve(vehicle.outputs.size());
  for (const Outputs& outputs : vehicle.outputs) {
    log.thrusters.push_back({outputs.time_s, PulseOn(outputs.pulse_us, log.port->channel),
                             PulseOn(outputs.pulse_us, log.starboard->channel)});
  }
}

std::string MavlinkRecording::RateWarnings(const Vehicle& vehicle, const SourceLog& log) {
  const auto ask = [](const char* parameter, const char* message) {
    return std::string("set ") + parameter +
           " to 10 (SR1_, SR2_ of another port), or ask for message " + message +
           " by MAV_CMD_SET_MESSAGE_INTERVAL";
  };
  const bool has_raw = !vehicle.raw_fixes.empty();
  return RateWarning("SERVO_OUTPUT_RAW", vehicle.outputs, kLowOutputHz, ask("SR0_RC_CHAN", "36")) +
         RateWarning(
             vehicle.attitude.empty() ? "GLOBAL_POSITION_INT" : "ATTITUDE", log.heading,
             kLowHeadingHz,
             vehicle.attitude.empty() ? ask("SR0_POSITION", "33") : ask("SR0_EXTRA1", "30")) +
         RateWarning(has_raw ? "GPS_RAW_INT" : "GLOBAL_POSITION_INT", log.gnss, kLowPositionHz,
                     has_raw ? ask("SR0_EXT_STAT", "24") : ask("SR0_POSITION", "33"));
}

SourceLog MavlinkRecording::Finish(const SourceOptions& options) const {
  SourceLog log;
  log.summary = std::to_string(messages_) + " MAVLink messages of use";
  const auto* chosen = Chosen(options);
  if (chosen == nullptr) {
    if (options.system_id)
      log.summary += "; none from system " + std::to_string(*options.system_id);
    return log;
  }
  const auto& [system, vehicle] = *chosen;
  log.summary += "; system " + std::to_string(system);
  if (vehicles_.size() > 1) log.summary += " of " + std::to_string(vehicles_.size());
  ChoosePositions(vehicle, log);
  ChooseHeadings(vehicle, log);
  ChooseOutputs(vehicle, options, log);
  log.summary += RateWarnings(vehicle, log) +
                 AndCount(vehicle.without_fix, "positions without a fix") +
                 AndCount(vehicle.repeated_fixes, "positions sent again");
  return log;
}

Result<SourceLog> ReadMavlinkTelemetryLog(const std::filesystem::path& file,
                                          const SourceOptions& options) {
  if (auto refusal = options.Validate()) return tl::unexpected(*std::move(refusal));
  MavlinkRecording recording;
  MavlinkTelemetryLog frames;
  const auto read = ReadInBlocks(file, [&](std::span<const std::uint8_t> bytes, bool at_end) {
    return frames.Consume(bytes, at_end,
                          [&](auto, const MavlinkFrame& frame) { recording.Take(frame); });
  });
  if (!read) return tl::unexpected(read.error());

  SourceLog log = recording.Finish(options);
  log.summary += AndCount(frames.Damage().corrupt_frames, "messages with a wrong checksum") +
                 AndCount(frames.Damage().skipped_bytes, "bytes skipped") +
                 AndCount(frames.Damage().truncated_bytes, "bytes of a message cut off at the end");
  return Complete(std::move(log), file);
}

}  // namespace telltale
