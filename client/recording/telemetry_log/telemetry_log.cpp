#include "telltale/client/recording/telemetry_log/telemetry_log.hpp"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <fstream>
#include <iterator>
#include <limits>
#include <optional>
#include <string>
#include <system_error>
#include <utility>

#include "telltale/core/data/window.hpp"

namespace telltale {
namespace {

constexpr double kLongestPauseS = 86400.0;  // that a clock runs through

constexpr std::size_t kBytesAtOnce = std::size_t{1} << 16;
constexpr int kTimeDecimals = 9;
constexpr int kPositionDecimals = 9;
constexpr int kHeadingDecimals = 6;
constexpr int kPulseDecimals = 3;

constexpr std::array<std::string_view, 3> kGnssColumns = {"time_s", "latitude_deg",
                                                          "longitude_deg"};
constexpr std::array<std::string_view, 2> kHeadingColumns = {"time_s", "heading_deg"};
constexpr std::array<std::string_view, 3> kThrusterColumns = {"time_s", "left_us", "right_us"};

GnssFix SampleFrom(std::span<const double> row, const GnssFix*) {
  return {row[0], row[1], row[2]};
}
HeadingSample SampleFrom(std::span<const double> row, const HeadingSample*) {
  return {row[0], row[1]};
}
ThrusterSample SampleFrom(std::span<const double> row, const ThrusterSample*) {
  return {row[0], row[1], row[2]};
}

template <class Sample>
Result<MalformedRows> ReadChannel(const std::filesystem::path& file,
                                  std::span<const std::string_view> columns,
                                  SampleSeries<Sample>& samples) {
  auto malformed = ReadCsv(file, columns, [&](std::span<const double> row) {
    samples.Add(SampleFrom(row, static_cast<const Sample*>(nullptr)));
  });
  if (!malformed || !samples.Samples().empty()) return malformed;
  const std::string rows =
      malformed->count == 0
          ? "has a header and no row"
          : "has no usable row, only " + std::to_string(malformed->count) + " malformed rows";
  return Refuse(file.string(), rows, "write one row of numbers per sample");
}

WindowLimits OneDayWindow() {
  WindowLimits limits;
  limits.duration_s = kLongestRecordingS;
  limits.memory_bytes = std::numeric_limits<std::size_t>::max() / 2;
  return limits;
}

std::string Reasons(const RejectCounts& rejected, Channel channel) {
  std::string reasons;
  for (const RejectReason reason : kRejectReasons) {
    const auto count = rejected.Of(channel, reason);
    if (count == 0) continue;
    reasons +=
        (reasons.empty() ? "" : ", ") + std::to_string(count) + " " + std::string(Name(reason));
  }
  return reasons.empty() ? "no samples" : reasons;
}

std::optional<Refusal> RefuseEmpty(const Window& window) {
  for (const Channel channel : kChannels) {
    if (window.Size(channel) > 0) continue;
    return Refusal{std::string(Name(channel)),
                   "no sample of this channel can be used: " + Reasons(window.Rejected(), channel),
                   "check the channel's source, its units and its clock"};
  }
  return std::nullopt;
}

// ---- one clock for several recordings ------------------------------------------------------

double StartOf(const Recording& r) {
  return std::min({r.gnss.front().time_s, r.heading.front().time_s, r.thrusters.front().time_s});
}

double EndOf(const Recording& r) {
  return std::max({r.gnss.back().time_s, r.heading.back().time_s, r.thrusters.back().time_s});
}

bool IsEmpty(const Recording& r) {
  return r.gnss.empty() || r.heading.empty() || r.thrusters.empty();
}

double ShiftAfter(double end_s, double start_s) {
  const double pause_s = start_s - end_s;
  const bool may_stay = pause_s >= kGapBetweenLogsS && pause_s <= kLongestPauseS;
  return may_stay ? 0.0 : end_s + kGapBetweenLogsS - start_s;
}

/// The first that is appended, which nothing shifts, is moved.
template <class Sample>
void AppendShifted(std::vector<Sample> from, double shift_s, std::vector<Sample>& to) {
  if (to.empty() && shift_s == 0.0) {
    to = std::move(from);
    return;
  }
  for (Sample sample : from) {
    sample.time_s += shift_s;
    to.push_back(sample);
  }
}

// ---- writing ---------------------------------------------------------------------------------

std::string HeaderOf(std::span<const std::string_view> columns) {
  std::string header;
  for (const std::string_view column : columns) {
    header.append(header.empty() ? "" : ",").append(column);
  }
  return header + '\n';
}

// Digits beyond the last one that matters are left out, and so are zeros at the end.
void AppendNumber(std::string& text, double value, int decimals, char after) {
  char number[400];
  const auto written =
      std::to_chars(number, std::end(number), value, std::chars_format::fixed, decimals);
  std::string_view digits(number, static_cast<std::size_t>(written.ptr - number));
  digits = digits.substr(0, digits.find_last_not_of('0') + 1);
  if (digits.ends_with('.')) digits.remove_suffix(1);
  text.append(digits).push_back(after);
}

/// `append` puts a sample behind a text, as a row. The rows are never in memory all at once.
template <class Sample, class Append>
void WriteRows(const std::filesystem::path& file, std::span<const std::string_view> columns,
               const std::vector<Sample>& samples, Append append) {
  std::ofstream stream(file, std::ios::binary | std::ios::trunc);
  std::string rows = HeaderOf(columns);
  for (const Sample& sample : samples) {
    append(rows, sample);
    if (rows.size() < kBytesAtOnce) continue;
    stream << rows;
    rows.clear();
  }
  stream << rows;
  stream.close();
  if (!stream) {
    throw std::system_error(errno, std::generic_category(), "cannot write " + file.string());
  }
}

}  // namespace

Result<TelemetryLog> ReadTelemetryLog(const std::filesystem::path& folder, std::size_t most_bytes) {
  if (!std::filesystem::is_directory(folder)) {
    return Refuse(folder.string(), "is not a folder",
                  "give a folder with gnss.csv, heading.csv and thrusters.csv");
  }
  TelemetryLog log;
  SampleMemory memory(most_bytes);
  SampleSeries<GnssFix> gnss(memory);
  SampleSeries<HeadingSample> heading(memory);
  SampleSeries<ThrusterSample> thrusters(memory);
  const auto read = [&](Channel channel, std::span<const std::string_view> columns, auto& samples) {
    const std::string file = std::string(Name(channel)) + ".csv";
    auto malformed = ReadChannel(folder / file, columns, samples);
    if (malformed) {
      log.malformed[static_cast<std::size_t>(channel)] = *std::move(malformed);
    } else {
      log.lacks.push_back({file, malformed.error().reason, malformed.error().advice});
    }
  };
  read(Channel::kGnss, kGnssColumns, gnss);
  read(Channel::kHeading, kHeadingColumns, heading);
  read(Channel::kThrusters, kThrusterColumns, thrusters);
  log.channels = {std::move(gnss).Release(), std::move(heading).Release(),
                  std::move(thrusters).Release()};
  log.left_out = memory.Summary();
  return log;
}

Result<AdmittedLog> Admit(RawChannels channels) {
  Window window(OneDayWindow());
  ForEachInOrderOfTime(channels, [&](const RawSample& raw) {
    std::visit([&window](const auto& sample) { window.Add(sample); }, raw);
  });
  const std::size_t taken = channels.Size();
  channels = {};
  if (auto refusal = RefuseEmpty(window)) return tl::unexpected(*refusal);
  std::size_t accounted_for = window.Rejected().Total();
  for (const Channel channel : kChannels) accounted_for += window.Size(channel);
  return AdmittedLog{std::move(window).Release(), taken - accounted_for};
}

Recording Concatenate(std::vector<Recording> recordings) {
  Recording all;
  for (Recording& recording : recordings) {
    all.rejected.Add(recording.rejected);
    if (IsEmpty(recording)) continue;
    const double shift_s = IsEmpty(all) ? 0.0 : ShiftAfter(EndOf(all), StartOf(recording));
    all.starts_s.push_back(StartOf(recording) + shift_s);
    AppendShifted(std::move(recording.gnss), shift_s, all.gnss);
    AppendShifted(std::move(recording.heading), shift_s, all.heading);
    AppendShifted(std::move(recording.thrusters), shift_s, all.thrusters);
  }
  return all;
}

void WriteTelemetryLog(const std::filesystem::path& folder, const Recording& recording) {
  std::filesystem::create_directories(folder);
  WriteRows(folder / "gnss.csv", kGnssColumns, recording.gnss,
            [](std::string& row, const GnssFix& fix) {
              AppendNumber(row, fix.time_s, kTimeDecimals, ',');
              AppendNumber(row, fix.latitude_deg, kPositionDecimals, ',');
              AppendNumber(row, fix.longitude_deg, kPositionDecimals, '\n');
            });
  WriteRows(folder / "heading.csv", kHeadingColumns, recording.heading,
            [](std::string& row, const HeadingSample& sample) {
              AppendNumber(row, sample.time_s, kTimeDecimals, ',');
              AppendNumber(row, sample.heading_deg, kHeadingDecimals, '\n');
            });
  WriteRows(folder / "thrusters.csv", kThrusterColumns, recording.thrusters,
            [](std::string& row, const ThrusterSample& sample) {
              AppendNumber(row, sample.time_s, kTimeDecimals, ',');
              AppendNumber(row, sample.port_us, kPulseDecimals, ',');
              AppendNumber(row, sample.starboard_us, kPulseDecimals, '\n');
            });
}

Result<CommandLog> ReadCommands(const std::filesystem::path& file) {
  SampleMemory memory(std::numeric_limits<std::size_t>::max());  // a simulation takes all
  SampleSeries<ThrusterSample> commands(memory);
  const auto malformed = ReadChannel(file, kThrusterColumns, commands);
  if (!malformed) return tl::unexpected(malformed.error());
  Window window(OneDayWindow());
  for (const ThrusterSample& sample : commands.Samples()) window.Add(sample);
  if (window.Empty()) {
    return Refuse(file.string(),
                  "has no usable row: " + Reasons(window.Rejected(), Channel::kThrusters),
                  "give pulse widths in [500, 2500] us");
  }
  return CommandLog{window.Snapshot().thrusters, *malformed, window.Rejected()};
}

}  // namespace telltale
