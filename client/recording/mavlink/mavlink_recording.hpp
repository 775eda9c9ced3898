#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "telltale/client/recording/mavlink/mavlink_messages.hpp"
#include "telltale/client/recording/pulse_columns.hpp"
#include "telltale/client/recording/sample_memory.hpp"
#include "telltale/client/recording/source_log.hpp"

namespace telltale {

/// The output of bank 0, [1, 16], that drives a thruster: the one asked for, else the one that has
/// this SERVOn_FUNCTION.
std::optional<int> ThrusterChannel(std::optional<int> asked, const AutopilotParameters& parameters,
                                   int function);

/// The pulse on an output. Requires: a channel of [1, 16].
double PulseOn(const MavlinkPulses& pulse_us, int channel);

/// Who sent a message: a vehicle and which part of it.
struct MavlinkSender {
  // Tests and readers speak of a vehicle, whose autopilot it is.
  MavlinkSender(int of_system, int of_component = kMavlinkAutopilot)  // NOLINT(*-explicit-*)
      : system(of_system), component(of_component) {}

  int system;
  int component;
  auto operator<=>(const MavlinkSender&) const = default;
};

/// Gathers what the vehicles of a MAVLink stream say; which vehicle and which of its sources count
/// is chosen once the stream has ended: of the components that report outputs, or else of all, the
/// one with most samples. A camera or a gimbal may have an attitude of its own.
///
/// Clock: seconds since the autopilot booted, for the three channels. GPS_RAW_INT bears the time of
/// its fix, ATTITUDE and SERVO_OUTPUT_RAW the time at which they were measured; none depends on
/// when a message arrived. A GPS_RAW_INT on the UNIX clock is brought to the autopilot's by
/// SYSTEM_TIME. Position: GPS_RAW_INT with a three-dimensional fix, else GLOBAL_POSITION_INT. A fix
/// that is sent again counts once. Heading: yaw of ATTITUDE, else hdg of GLOBAL_POSITION_INT; both
/// are true. Outputs: SERVO_OUTPUT_RAW of bank 0; SERVOn_FUNCTION 73 and 74 of PARAM_VALUE name the
/// thrusters.
class MavlinkRecording {
 public:
  /// `most_bytes`: of SampleMemory.
  explicit MavlinkRecording(std::size_t most_bytes = kReadingBytes) : memory_(most_bytes) {}

  /// A frame of any message; those of no use are passed over.
  void Take(const MavlinkFrame& frame);

  void Take(const MavlinkSender& sender, const MavlinkGpsRawInt& message);
  void Take(const MavlinkSender& sender, const MavlinkGlobalPositionInt& message);
  void Take(const MavlinkSender& sender, const MavlinkAttitude& message);
  void Take(const MavlinkSender& sender, const MavlinkServoOutputRaw& message);
  void Take(const MavlinkSender& sender, const MavlinkParamValue& message);
  void Take(const MavlinkSender& sender, const MavlinkSystemTime& message);

  /// Gives the samples away, so that no file stands in memory twice.
  /// Requires: options.Validate() is empty.
  SourceLog Finish(const SourceOptions& options) &&;

 private:
  struct Vehicle {
    explicit Vehicle(SampleMemory& memory)
        : raw_fixes(memory),
          filtered_fixes(memory),
          attitude(memory),
          filtered_heading(memory),
          outputs(memory) {}

    SampleSeries<GnssFix> raw_fixes;
    SampleSeries<GnssFix> filtered_fixes;  ///< none once there is a raw one
    SampleSeries<HeadingSample> attitude;
    SampleSeries<HeadingSample> filtered_heading;  ///< none once there is an attitude
    PulseColumns outputs;
    AutopilotParameters parameters;
    std::uint64_t without_fix = 0;
    std::uint64_t repeated_fixes = 0;
    std::optional<double> boot_s;  ///< of the newest message that bears it
    std::uint32_t last_output_us = 0;
    std::uint64_t output_wraps = 0;
    std::optional<double> unix_less_boot_s;

    std::size_t Samples() const;
  };

  Vehicle& VehicleOf(const MavlinkSender& sender) {
    return vehicles_.try_emplace(sender, memory_).first->second;
  }
  std::pair<const MavlinkSender, Vehicle>* Chosen(const SourceOptions& options);
  static double OutputTime(Vehicle& vehicle, std::uint32_t time_us);
  // Each fills a channel, and returns the warning of a rate that is too low, if it is.
  static std::string ChoosePositions(Vehicle& vehicle, SourceLog& log);
  static std::string ChooseHeadings(Vehicle& vehicle, SourceLog& log);
  static std::string ChooseOutputs(const Vehicle& vehicle, const SourceOptions& options,
                                   SourceLog& log);

  std::size_t SystemsWithSamples() const;

  SampleMemory memory_;
  std::map<MavlinkSender, Vehicle> vehicles_;
  std::uint64_t messages_ = 0;
};

/// A telemetry log of a ground station (tlog), or the same frames without their times of arrival,
/// as they come out of a serial line.
/// Channels may be missing. Refuses when: the file cannot be read.
Result<SourceLog> ReadMavlinkTelemetryLog(const std::filesystem::path& file,
                                          const SourceOptions& options = {});

}  // namespace telltale
