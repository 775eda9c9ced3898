#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "telltale/client/recording/load_recording.hpp"
#include "telltale/core/base/result.hpp"
#include "telltale/core/data/check/input_check.hpp"
#include "telltale/core/data/samples.hpp"
#include "telltale/core/identification/channel_delays.hpp"
#include "telltale/core/identification/progress.hpp"
#include "telltale/core/vessel/vehicle.hpp"

namespace telltale {

/// One log as it was recorded, and what the check says of it.
struct CheckedLog {
  std::filesystem::path path;
  std::string summary;  ///< what the file says of itself; empty for a folder
  InputCheck check;
  std::optional<RejectCounts> rejected;  ///< unset: a channel is missing or rejected whole
  std::vector<Refusal> lacks;            ///< each channel that is missing
  std::optional<Refusal> unusable;       ///< why nothing can be identified from it
  Result<ChannelDelays> delays;

  std::optional<Refusal> FirstProblem() const;
};

/// Seeks faults of input in the channels of a log (CheckInput), says whether it can be prepared
/// (WhyNotPrepared), and estimates the delays between its channels (EstimateChannelDelays). Those
/// of a log with a fault of input are not estimated.
CheckedLog CheckLog(const std::filesystem::path& path, RawLog log, const Vehicle& vehicle,
                    const Progress& progress);

/// The vehicle that a log describes, else one whose thrusters take 1100, 1500 and 1900 us for full
/// reverse, neutral and full forward.
Vehicle DescribedOrUsualVehicle(const std::optional<LogDescription>& description);

}  // namespace telltale
