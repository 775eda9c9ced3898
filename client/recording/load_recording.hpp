#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "telltale/client/recording/csv/numeric_csv.hpp"
#include "telltale/client/recording/source_log.hpp"
#include "telltale/client/recording/time_order.hpp"
#include "telltale/core/base/result.hpp"
#include "telltale/core/data/samples.hpp"
#include "telltale/core/vessel/vehicle.hpp"

namespace telltale {

/// What a file says of itself besides its samples; a folder of CSV files says nothing.
struct LogDescription {
  std::string summary;                 ///< what was read, from where, and each kind of damage
  std::optional<ThrusterOutput> port;  ///< where the file describes its outputs
  std::optional<ThrusterOutput> starboard;
};

/// A log of any format before any admission.
struct RawLog {
  RawChannels channels;
  std::array<MalformedRows, 3> malformed;  ///< by channel, of a folder
  std::optional<LogDescription> description;
  std::vector<Refusal> lacks;  ///< each channel that is missing, with the reason and what to do
};

/// A log of any format as far as it can be trusted: what identifications and validations take.
struct LoadedRecording {
  Recording recording;
  std::size_t evicted = 0;                 ///< samples a window let go again, as in AdmittedLog
  std::array<MalformedRows, 3> malformed;  ///< by channel, of a folder
  std::optional<LogDescription> description;
};

enum class LogFormat {
  kUnknown,
  kTelemetryLog,
  kDataFlash,
  kMavlink,
  kMcap,
  kRosbag1,
  kRosbag2,
  kCompressed  ///< with gzip or zstd, as a whole
};

/// By what the path holds, not by its name: a folder of .db3 or .mcap files, compressed or not, is
/// a rosbag2 recording, any other folder a telemetry log; a file is told by its first 64 KiB.
LogFormat FormatOf(const std::filesystem::path& path);

/// A telemetry log (gnss.csv, heading.csv and thrusters.csv of one folder), an ArduPilot DataFlash
/// file, a MAVLink telemetry log, an MCAP file, a rosbag2 recording or a ROS 1 .bag; a file of
/// these that gzip or zstd has compressed, or a folder that holds one such file alone. Channels may
/// be missing. Refuses when: the path is none of them, or cannot be read.
Result<RawLog> ReadLog(const std::filesystem::path& path, const SourceOptions& options = {});

/// The refusal of the first channel that is missing. It names the path and what was read of it.
std::optional<Refusal> LacksChannel(const std::filesystem::path& path, const RawLog& log);

/// What Admit keeps of a log. Refuses when: a channel is missing, it does, or times, positions or
/// commands are plainly in other units than those of a telemetry log (UnitFault); the subject names
/// the path.
Result<LoadedRecording> AdmitLog(const std::filesystem::path& path, RawLog log);

/// ReadLog, then AdmitLog. Refuses when: either does.
Result<LoadedRecording> LoadRecording(const std::filesystem::path& path,
                                      const SourceOptions& options = {});

/// The vehicle that a log's servo parameters describe, for when no vehicle file is given.
/// The log knows neither the separation of the propellers nor the antenna's place: both are zero,
/// which identification and validation can do with.
/// Refuses when: the log does not describe a thruster, or its parameters are missing or unsound.
Result<Vehicle> VehicleFrom(const LogDescription& description, const std::string& vehicle_id);

}  // namespace telltale
