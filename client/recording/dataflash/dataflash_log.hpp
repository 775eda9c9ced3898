#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "telltale/client/recording/block_reader.hpp"
#include "telltale/client/recording/dataflash/dataflash_records.hpp"
#include "telltale/client/recording/sample_memory.hpp"
#include "telltale/client/recording/servo_outputs.hpp"
#include "telltale/client/recording/time_order.hpp"
#include "telltale/core/base/result.hpp"
#include "telltale/core/vessel/propellers.hpp"

namespace telltale {

/// The last output that RCOU records; RCO2 and RCO3, which are not read, hold the others.
inline constexpr int kLoggedChannels = 14;

/// What to take from a log where it offers a choice. Channels are counted from 1, as on the
/// autopilot.
struct DataFlashOptions {
  std::optional<int>
      gps_instance;  ///< [0, 255]; unset: the one with most fixes, the first of equals
  std::optional<int> port_channel;       ///< [1, 14]; unset: SERVOn_FUNCTION 73 (ThrottleLeft)
  std::optional<int> starboard_channel;  ///< [1, 14]; unset: SERVOn_FUNCTION 74 (ThrottleRight)

  std::size_t memory_bytes = kReadingBytes;  ///< of SampleMemory

  /// The first field out of its range, as a refusal naming field, value and range.
  std::optional<Refusal> Validate() const;
};

enum class HeadingSource { kUnknown, kAtt, kAhr2 };

std::string_view Name(HeadingSource source);

/// What a log held and what was wrong with it, by name and count.
struct DataFlashReport {
  std::uint64_t bytes = 0;
  std::map<std::string, std::uint64_t> records;  ///< whole records by message name, FMT included
  DataFlashDamage damage;
  std::map<std::string, std::uint64_t> unreadable;  ///< records by what their definition lacks
  std::map<std::string, std::uint64_t> time_leaps;  ///< by message: back at all, or ahead over 60 s
  std::map<std::string, std::uint64_t> changed_parameters;  ///< used ones; the last value counts
  std::map<int, std::uint64_t> gps_fixes;                   ///< by instance
  std::uint64_t gps_without_fix = 0;                        ///< Status below 3, every instance
  std::optional<int> gps_instance;                          ///< the one taken
  HeadingSource heading_source = HeadingSource::kUnknown;
  std::string left_out;  ///< SampleMemory::Summary()

  /// A sentence or two for a person: what was read and each kind of damage that occurred.
  std::string Summary() const;
};

/// The telemetry of a DataFlash log as it was logged: in log order. Only the fix status is checked.
///
/// Times are seconds of the autopilot's clock since it started, the same for the three channels. A
/// fix bears the time at which it was logged (TimeUS, or T in ms before Rover 3), not its GPS time
/// (GMS, GWk), so it lags by what the receiver and its link take.
/// Heading is the yaw of the attitude estimate, clockwise from true north (AHRS adds declination).
struct DataFlashLog : RawChannels {
  std::optional<ThrusterOutput> port;
  std::optional<ThrusterOutput> starboard;
  DataFlashReport report;

  /// Why the bytes are no DataFlash log.
  std::optional<Refusal> Unreadable() const;

  /// Each channel that is missing, in the order of kChannels: names the message or parameter and
  /// how to log it.
  std::vector<Refusal> Lacks() const;
};

/// Everything that can be had from these bytes; never fails, a log of nothing included.
/// Reads: GPS, GPS2, GPSB (Status, Lat, Lng at Status 3 and above), ATT or else AHR2 (Yaw), RCOU
/// (C1..C14), PARM (SERVOn_*, or RCn_* of firmware that has no SERVOn_FUNCTION).
/// Memory: as far as SampleMemory goes.
/// Requires: options.Validate() is empty.
DataFlashLog ParseDataFlash(DataFlashBytes bytes, const DataFlashOptions& options);

/// The same from a file, read once in blocks.
/// Refuses when: the file cannot be read or the log is Unreadable().
Result<DataFlashLog> ReadDataFlash(const std::filesystem::path& file,
                                   const DataFlashOptions& options = {},
                                   const ReadProgress& progress = nullptr);

}  // namespace telltale
