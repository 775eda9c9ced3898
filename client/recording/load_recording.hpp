#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "telltale/client/recording/csv/numeric_csv.hpp"
#include "telltale/client/recording/dataflash/dataflash_log.hpp"
#include "telltale/client/recording/time_order.hpp"
#include "telltale/core/base/result.hpp"
#include "telltale/core/data/samples.hpp"
#include "telltale/core/vessel/vehicle.hpp"

namespace telltale {

/// What only a DataFlash log says besides its samples.
struct DataFlashSource {
  DataFlashReport report;
  ThrusterOutput port;
  ThrusterOutput starboard;
};

/// A log of either kind before any admission: what a replay publishes.
struct RawLog {
  std::vector<RawSample> samples;          ///< InOrderOfTime()
  std::array<MalformedRows, 3> malformed;  ///< by channel, of a folder
  std::optional<DataFlashSource> dataflash;
};

/// A log of either kind as far as it can be trusted: what identifications and validations take.
struct LoadedRecording {
  Recording recording;
  std::size_t evicted = 0;                 ///< samples a window let go again, as in AdmittedLog
  std::array<MalformedRows, 3> malformed;  ///< by channel, of a folder
  std::optional<DataFlashSource> dataflash;
};

/// A folder of gnss.csv, heading.csv and thrusters.csv, or an ArduPilot DataFlash file.
/// Refuses when: the path is neither, cannot be read, or holds nothing of a channel. `options`
/// concern DataFlash files alone.
Result<RawLog> ReadLog(const std::filesystem::path& path, const DataFlashOptions& options = {});

/// ReadLog, then Admit. Refuses when: either does; the subject names the path.
Result<LoadedRecording> LoadRecording(const std::filesystem::path& path,
                                      const DataFlashOptions& options = {});

/// The vehicle that a DataFlash log's servo parameters describe, for when no vehicle file is given.
/// The log knows neither the separation of the propellers nor the antenna's place: both are zero,
/// which identification and validation can do with.
/// Refuses when: the parameters of a thruster's channel are missing or unsound.
Result<Vehicle> VehicleFrom(const DataFlashSource& source, const std::string& vehicle_id);

}  // namespace telltale
