#include "telltale/client/recording/load_recording.hpp"

#include <algorithm>
#include <fstream>
#include <string_view>
#include <utility>

#include "telltale/client/recording/csv/mapped_csv.hpp"
#include "telltale/client/recording/dataflash/dataflash_log.hpp"
#include "telltale/client/recording/mavlink/mavlink_recording.hpp"
#include "telltale/client/recording/mcap/mcap_recording.hpp"
#include "telltale/client/recording/mcap/mcap_records.hpp"
#include "telltale/client/recording/rosbag1/rosbag1.hpp"
#include "telltale/client/recording/rosbag2/rosbag2.hpp"
#include "telltale/client/recording/telemetry_log/telemetry_log.hpp"
#include "telltale/client/recording/zstd_frame.hpp"
#include "telltale/core/data/input_check.hpp"

namespace telltale {
namespace {

constexpr std::size_t kBytesToTellFormat = std::size_t{64} << 10;
constexpr const char* kReadableFormats =
    "give a folder of CSV files, an ArduPilot .BIN, a .tlog, an .mcap, a rosbag2 folder or "
    ".db3, a ROS 1 .bag, or one CSV file with --map";

std::string FirstBytes(const std::filesystem::path& file) {
  std::string bytes(kBytesToTellFormat, '\0');
  std::ifstream in(file, std::ios::binary);
  in.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  bytes.resize(static_cast<std::size_t>(in.gcount()));
  return bytes;
}

Result<RawLog> FromFolder(const std::filesystem::path& folder) {
  return ReadTelemetryLog(folder).map([](TelemetryLog log) {
    return RawLog{std::move(log.channels), log.malformed, std::nullopt};
  });
}

std::string OutputsText(const DataFlashLog& log) {
  if (!log.port || !log.starboard) return {};
  return "; outputs " + std::to_string(log.port->channel) + " (port) and " +
         std::to_string(log.starboard->channel) + " (starboard) of RCOU";
}

Result<RawLog> FromDataFlash(const std::filesystem::path& file, const SourceOptions& options) {
  const DataFlashOptions choice{options.gps_instance, options.port_channel,
                                options.starboard_channel};
  return ReadDataFlash(file, choice, options.progress).map([](DataFlashLog log) {
    LogDescription description{log.report.Summary() + OutputsText(log), log.port, log.starboard};
    return RawLog{std::move(log), {}, std::move(description)};
  });
}

/// "a MAVLink telemetry log" and the like: of formats whose messages have a fixed meaning.
const char* FixedFormat(LogFormat format) {
  switch (format) {
    case LogFormat::kTelemetryLog: return "a folder of a telemetry log";
    case LogFormat::kDataFlash: return "an ArduPilot DataFlash log";
    case LogFormat::kMavlink: return "a MAVLink telemetry log";
    default: return nullptr;
  }
}

Result<SourceLog> ReadMapped(const std::filesystem::path& path, LogFormat format,
                             const SourceOptions& options) {
  if (const char* fixed = FixedFormat(format)) {
    return Refuse(path.string(),
                  std::string("is ") + fixed + ", whose columns and messages have a fixed meaning",
                  "leave out --map, which is for one CSV file, MCAP, rosbag2 and ROS 1");
  }
  switch (format) {
    case LogFormat::kMcap: return ReadMcap(path, options);
    case LogFormat::kRosbag1: return ReadRosbag1(path, options);
    case LogFormat::kRosbag2: return ReadRosbag2(path, options);
    default: return ReadMappedCsv(path, *options.mapping, options.progress);
  }
}

Result<RawLog> FromSource(Result<SourceLog> source) {
  return std::move(source).map([](SourceLog log) {
    LogDescription description{std::move(log.summary), log.port, log.starboard};
    return RawLog{std::move(log), {}, std::move(description)};
  });
}

tl::unexpected<Refusal> Naming(const std::filesystem::path& path, Refusal refusal) {
  refusal.subject = path.string() + " " + refusal.subject;
  return tl::unexpected(std::move(refusal));
}

Refusal UnknownFormat(const std::filesystem::path& path) {
  std::error_code error;
  const auto bytes = std::filesystem::file_size(path, error);
  if (error) return {path.string(), "cannot be read: " + error.message(), kReadableFormats};
  if (bytes == 0) return {path.string(), "is empty", "copy or download the recording again"};
  return {path.string(), "is of no format that can be read, by its content", kReadableFormats};
}

Result<PwmChannel> RangeOf(const std::optional<ThrusterOutput>& output, const char* thruster) {
  const std::string subject = std::string(thruster) + " thruster";
  if (!output) return Refuse(subject, "is not described by the log", "give a vehicle file");
  if (output->range) return *output->range;
  return Refuse(subject, output->range_fault, "give a vehicle file");
}

}  // namespace

LogFormat FormatOf(const std::filesystem::path& path) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) {
    return IsRosbag2Folder(path) ? LogFormat::kRosbag2 : LogFormat::kTelemetryLog;
  }
  const std::string begin = FirstBytes(path);
  const std::span<const std::uint8_t> bytes(reinterpret_cast<const std::uint8_t*>(begin.data()),
                                            begin.size());
  if (BeginsLikeMcap(bytes)) return LogFormat::kMcap;
  if (begin.starts_with("SQLite format 3")) return LogFormat::kRosbag2;
  if (BeginsLikeZstdFrame(bytes)) return LogFormat::kRosbag2;  // a file of it, compressed
  if (BeginsLikeRosbag1(bytes)) return LogFormat::kRosbag1;
  if (BeginsLikeMavlinkTelemetryLog(bytes)) return LogFormat::kMavlink;
  // A damaged log may begin with anything; the definition of a message stands near its start.
  const bool defines_messages = begin.find("\xA3\x95\x80") != std::string::npos;
  return defines_messages ? LogFormat::kDataFlash : LogFormat::kUnknown;
}

Result<RawLog> ReadLog(const std::filesystem::path& path, const SourceOptions& options) {
  const LogFormat format = FormatOf(path);
  if (options.mapping) return FromSource(ReadMapped(path, format, options));
  switch (format) {
    case LogFormat::kTelemetryLog: return FromFolder(path);
    case LogFormat::kMavlink: return FromSource(ReadMavlinkTelemetryLog(path, options));
    case LogFormat::kMcap: return FromSource(ReadMcap(path, options));
    case LogFormat::kRosbag1: return FromSource(ReadRosbag1(path, options));
    case LogFormat::kRosbag2: return FromSource(ReadRosbag2(path, options));
    case LogFormat::kDataFlash: return FromDataFlash(path, options);
    case LogFormat::kUnknown: break;
  }
  return tl::unexpected(UnknownFormat(path));
}

Result<LoadedRecording> AdmitLog(const std::filesystem::path& path, const RawLog& log) {
  auto fault = UnitFault(log.channels.gnss, log.channels.thrusters);
  if (fault) return Naming(path, *std::move(fault));
  auto admitted = Admit(log.channels);
  if (!admitted) return Naming(path, std::move(admitted).error());
  return LoadedRecording{std::move(admitted->recording), admitted->evicted, log.malformed,
                         log.description};
}

Result<LoadedRecording> LoadRecording(const std::filesystem::path& path,
                                      const SourceOptions& options) {
  const auto log = ReadLog(path, options);
  if (!log) return tl::unexpected(log.error());
  return AdmitLog(path, *log);
}

Result<Vehicle> VehicleFrom(const LogDescription& description, const std::string& vehicle_id) {
  const auto port = RangeOf(description.port, "port");
  if (!port) return tl::unexpected(port.error());
  const auto starboard = RangeOf(description.starboard, "starboard");
  if (!starboard) return tl::unexpected(starboard.error());
  Vehicle vehicle;
  vehicle.vehicle_id = vehicle_id;
  vehicle.port = *port;
  vehicle.starboard = *starboard;
  return vehicle;
}

}  // namespace telltale
