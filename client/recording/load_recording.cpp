#include "telltale/client/recording/load_recording.hpp"

#include <algorithm>
#include <array>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "telltale/client/recording/block_reader.hpp"
#include "telltale/client/recording/csv/mapped_csv.hpp"
#include "telltale/client/recording/dataflash/dataflash_log.hpp"
#include "telltale/client/recording/gzip_file.hpp"
#include "telltale/client/recording/mavlink/mavlink_recording.hpp"
#include "telltale/client/recording/mcap/mcap_file.hpp"
#include "telltale/client/recording/mcap/mcap_recording.hpp"
#include "telltale/client/recording/rosbag1/rosbag1.hpp"
#include "telltale/client/recording/rosbag2/rosbag2.hpp"
#include "telltale/client/recording/telemetry_log/telemetry_log.hpp"
#include "telltale/client/recording/temporary_file.hpp"
#include "telltale/client/recording/trimmed.hpp"
#include "telltale/client/recording/zstd_frame.hpp"
#include "telltale/core/data/check/input_check.hpp"

namespace telltale {
namespace {

constexpr std::size_t kMostNamed = 5;  // of the recordings of a folder
constexpr std::size_t kMostOfALine = 200;
constexpr const char* kReadableFormats =
    "give a folder of CSV files, an ArduPilot .BIN, a .tlog, an .mcap, a rosbag2 folder or "
    ".db3, a ROS 1 .bag, or one CSV file with --map";

std::string_view TextOf(const std::vector<std::uint8_t>& bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

bool IsTelemetryLog(const std::filesystem::path& folder) {
  return std::ranges::any_of(std::array{"gnss.csv", "heading.csv", "thrusters.csv"},
                             [&](const char* file) { return exists(folder / file); });
}

/// The recordings that stand in a folder, by name.
std::vector<std::filesystem::path> RecordingsIn(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> recordings;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (!entry.is_regular_file() || FormatOf(entry.path()) == LogFormat::kUnknown) continue;
    recordings.push_back(entry.path());
  }
  std::ranges::sort(recordings);
  return recordings;
}

/// A folder with one recording is that recording. Several may have a clock each, and so are several
/// logs.
Result<RawLog> FromOtherFolder(const std::filesystem::path& folder, const SourceOptions& options) {
  const std::vector<std::filesystem::path> recordings = RecordingsIn(folder);
  if (recordings.size() == 1) return ReadLog(recordings.front(), options);
  if (recordings.empty()) return Refuse(folder.string(), "holds no recording", kReadableFormats);
  std::string names;
  for (const auto& recording :
       std::span(recordings).first(std::min(recordings.size(), kMostNamed))) {
    names += (names.empty() ? "" : ", ") + recording.filename().string();
  }
  return Refuse(folder.string(),
                "holds " + std::to_string(recordings.size()) + " recordings: " + names +
                    (recordings.size() > kMostNamed ? ", ..." : ""),
                "give each of them by a --log of its own");
}

/// A folder says nothing of itself; what was left out of it is said.
std::optional<LogDescription> DescriptionOf(const TelemetryLog& log) {
  if (log.left_out.empty()) return std::nullopt;
  return LogDescription{log.left_out, std::nullopt, std::nullopt};
}

Result<RawLog> FromFolder(const std::filesystem::path& folder, const SourceOptions& options) {
  if (!IsTelemetryLog(folder)) return FromOtherFolder(folder, options);
  return ReadTelemetryLog(folder, options.memory_bytes).map([](TelemetryLog log) {
    auto description = DescriptionOf(log);
    return RawLog{std::move(log.channels), log.malformed, std::move(description),
                  std::move(log.lacks)};
  });
}

std::string OutputsText(const DataFlashLog& log) {
  if (!log.port || !log.starboard) return {};
  return "; outputs " + std::to_string(log.port->channel) + " (port) and " +
         std::to_string(log.starboard->channel) + " (starboard) of RCOU";
}

Result<RawLog> FromDataFlash(const std::filesystem::path& file, const SourceOptions& options) {
  const DataFlashOptions choice{options.gps_instance, options.port_channel,
                                options.starboard_channel, options.memory_bytes};
  return ReadDataFlash(file, choice, options.progress).map([](DataFlashLog log) {
    LogDescription description{log.report.Summary() + OutputsText(log), log.port, log.starboard};
    auto lacks = log.Lacks();
    return RawLog{std::move(log), {}, std::move(description), std::move(lacks)};
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
    default: return ReadMappedCsv(path, *options.mapping, options);
  }
}

Result<RawLog> FromSource(Result<SourceLog> source) {
  return std::move(source).map([](SourceLog log) {
    LogDescription description{std::move(log.summary), log.port, log.starboard};
    auto lacks = log.Lacks();
    return RawLog{std::move(log), {}, std::move(description), std::move(lacks)};
  });
}

Refusal Naming(const std::filesystem::path& path, Refusal refusal) {
  refusal.subject = path.string() + " " + refusal.subject;
  return refusal;
}

/// Formats that are known and not read, by how they begin.
struct OtherFormat {
  std::string_view beginning;
  const char* reason;
  const char* advice;
};
constexpr std::array kOtherFormats = {
    OtherFormat{"ULog\x01\x12\x35", "is a ULog of PX4, which is not read",
                "record the boat by MAVLink or ROS 2, or make one CSV file of it and give --map"},
    OtherFormat{"FMT, ", "is a DataFlash log turned into text", "give the .BIN that it is made of"},
    OtherFormat{"PK\x03\x04", "is a zip archive", "unpack it, and give what it holds"},
    OtherFormat{"BZh", "is compressed with bzip2", "decompress it"},
    OtherFormat{"\xFD"
                "7zXZ",
                "is compressed with xz", "decompress it"}};

/// The first line of what seems to be a table of text; empty of anything else.
std::string_view FirstRow(std::string_view begin) {
  if (begin.starts_with(kByteOrderMark)) begin.remove_prefix(kByteOrderMark.size());
  const std::string_view line = Trimmed(begin.substr(0, begin.find('\n')));
  const auto is_of_text = [](char c) { return static_cast<unsigned char>(c) >= ' ' || c == '\t'; };
  const auto separates = [](char c) { return c == ',' || c == ';' || c == '\t'; };
  const bool is_row =
      std::ranges::all_of(line, is_of_text) && std::ranges::count_if(line, separates) >= 2;
  return is_row ? line : std::string_view();
}

Refusal UnknownFormat(const std::filesystem::path& path) {
  std::error_code error;
  const auto bytes = std::filesystem::file_size(path, error);
  if (error) return {path.string(), "cannot be read: " + error.message(), kReadableFormats};
  if (bytes == 0) return {path.string(), "is empty", "copy or download the recording again"};
  const std::vector<std::uint8_t> beginning = BeginningOf(path);
  const std::string_view begin = TextOf(beginning);
  for (const OtherFormat& other : kOtherFormats) {
    if (begin.starts_with(other.beginning)) return {path.string(), other.reason, other.advice};
  }
  if (const std::string_view row = FirstRow(begin); !row.empty()) {
    return {path.string(),
            "seems to be a CSV file, which begins with " + std::string(row.substr(0, kMostOfALine)),
            "say by --map FILE which columns hold times, positions, headings and commands"};
  }
  return {path.string(), "is of no format that can be read, by its content", kReadableFormats};
}

Result<bool> Inflate(const std::filesystem::path& file, const std::filesystem::path& into) {
  return BeginsLikeGzipFile(BeginningOf(file)) ? InflateGzipFile(file, into)
                                               : InflateZstdFile(file, into);
}

/// What is compressed once more inside is of no known format.
Result<RawLog> FromCompressed(const std::filesystem::path& path, const SourceOptions& options) {
  const TemporaryFile inflated;
  const auto is_whole = Inflate(path, inflated.Path());
  if (!is_whole) return tl::unexpected(is_whole.error());
  const std::string inside = inflated.Path().string();
  auto log = FormatOf(inside) == LogFormat::kCompressed ? tl::unexpected(UnknownFormat(inside))
                                                        : ReadLog(inside, options);
  if (!log) {
    std::string& subject = log.error().subject;
    const bool names_inside = subject.starts_with(inside);
    subject = path.string() + (*is_whole ? "" : ", which is cut off,") +
              (names_inside ? subject.substr(inside.size()) : ' ' + subject);
  } else if (!*is_whole && log->description) {
    log->description->summary += "; the compressed file is cut off";
  }
  return log;
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
  const std::vector<std::uint8_t> bytes = BeginningOf(path);
  const std::string_view begin = TextOf(bytes);
  if (HoldsMcap(bytes)) return LogFormat::kMcap;
  if (begin.starts_with("SQLite format 3")) return LogFormat::kRosbag2;
  if (BeginsLikeZstdFrame(bytes) || BeginsLikeGzipFile(bytes)) return LogFormat::kCompressed;
  if (BeginsLikeRosbag1(bytes)) return LogFormat::kRosbag1;
  if (BeginsLikeMavlinkTelemetryLog(bytes) || BeginsLikeMavlinkStream(bytes)) {
    return LogFormat::kMavlink;
  }
  // A damaged log may begin with anything; the definition of a message stands near its start.
  const bool defines_messages = begin.find("\xA3\x95\x80") != std::string_view::npos;
  return defines_messages ? LogFormat::kDataFlash : LogFormat::kUnknown;
}

Result<RawLog> ReadLog(const std::filesystem::path& path, const SourceOptions& options) {
  const LogFormat format = FormatOf(path);
  if (format == LogFormat::kCompressed) return FromCompressed(path, options);
  if (options.mapping) return FromSource(ReadMapped(path, format, options));
  switch (format) {
    case LogFormat::kTelemetryLog: return FromFolder(path, options);
    case LogFormat::kMavlink: return FromSource(ReadMavlinkTelemetryLog(path, options));
    case LogFormat::kMcap: return FromSource(ReadMcap(path, options));
    case LogFormat::kRosbag1: return FromSource(ReadRosbag1(path, options));
    case LogFormat::kRosbag2: return FromSource(ReadRosbag2(path, options));
    case LogFormat::kDataFlash: return FromDataFlash(path, options);
    case LogFormat::kCompressed:
    case LogFormat::kUnknown: break;
  }
  return tl::unexpected(UnknownFormat(path));
}

std::optional<Refusal> LacksChannel(const std::filesystem::path& path, const RawLog& log) {
  if (log.lacks.empty()) return std::nullopt;
  Refusal refusal = log.lacks.front();
  if (log.description) refusal.reason += " (" + log.description->summary + ')';
  return Naming(path, std::move(refusal));
}

Result<LoadedRecording> AdmitLog(const std::filesystem::path& path, RawLog log) {
  if (auto refusal = LacksChannel(path, log)) return tl::unexpected(*std::move(refusal));
  auto fault = UnitFault(log.channels.gnss, log.channels.thrusters);
  if (fault) return tl::unexpected(Naming(path, *std::move(fault)));
  auto admitted = Admit(std::move(log.channels));
  if (!admitted) return tl::unexpected(Naming(path, std::move(admitted).error()));
  return LoadedRecording{std::move(admitted->recording), admitted->evicted, log.malformed,
                         std::move(log.description)};
}

Result<LoadedRecording> LoadRecording(const std::filesystem::path& path,
                                      const SourceOptions& options) {
  auto log = ReadLog(path, options);
  if (!log) return tl::unexpected(std::move(log).error());
  return AdmitLog(path, *std::move(log));
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
