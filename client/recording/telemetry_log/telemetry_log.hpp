#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "telltale/client/recording/csv/numeric_csv.hpp"
#include "telltale/client/recording/sample_memory.hpp"
#include "telltale/client/recording/time_order.hpp"
#include "telltale/core/base/result.hpp"
#include "telltale/core/data/samples.hpp"

namespace telltale {

/// A telemetry log as it was written: gnss.csv, heading.csv and thrusters.csv of one folder.
struct TelemetryLog {
  RawChannels channels;                    ///< before any admission
  std::array<MalformedRows, 3> malformed;  ///< by channel
  std::string left_out;                    ///< SampleMemory::Summary() of reading it
  /// Each channel whose file is missing, empty, without its columns, or without one readable row.
  std::vector<Refusal> lacks;
};

/// Refuses when: the path is no folder.
Result<TelemetryLog> ReadTelemetryLog(const std::filesystem::path& folder,
                                      std::size_t most_bytes = kReadingBytes);

/// What of a log can be trusted, by the rules of a live Window with room for a day.
struct AdmittedLog {
  Recording recording;
  /// Samples a window let go again: older than a day, or before the clock was set back.
  std::size_t evicted = 0;
};

/// Takes the samples in order of time. Refuses when: a channel has nothing left. Memory: the
/// channels and the window, never three copies, of channels that are given away.
Result<AdmittedLog> Admit(RawChannels channels);

/// Recordings one after the other in one clock. A recording that starts within a day after the end
/// of the one before, and far enough to leave a gap no preparation bridges, keeps its times; any
/// other is shifted to start kGapBetweenLogsS after that end. Where each begins is kept.
inline constexpr double kGapBetweenLogsS = 120.0;
Recording Concatenate(std::vector<Recording> recordings);

/// Writes the folder's three files so that reading them gives the same samples back: times to the
/// nanosecond, degrees to 1e-9 (0.1 mm) and 1e-6 (heading), pulse widths to 1e-3 us.
/// Throws: std::system_error when the folder or a file cannot be written.
void WriteTelemetryLog(const std::filesystem::path& folder, const Recording& recording);

/// A lone thrusters.csv: what a simulation is to be commanded. Rejected rows are counted, not used.
struct CommandLog {
  std::vector<ThrusterSample> commands;  ///< in order of time
  MalformedRows malformed;
  RejectCounts rejected;
};

/// Refuses when: the file is missing, empty, without its columns, or without one usable row.
Result<CommandLog> ReadCommands(const std::filesystem::path& file);

}  // namespace telltale
