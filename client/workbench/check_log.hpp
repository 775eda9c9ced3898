#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "telltale/client/recording/load_recording.hpp"
#include "telltale/core/base/result.hpp"
#include "telltale/core/data/input_check.hpp"
#include "telltale/core/data/samples.hpp"
#include "telltale/core/vessel/vehicle.hpp"

namespace telltale {

/// One log as it was recorded, and what the check says of it.
struct CheckedLog {
  std::filesystem::path path;
  std::string summary;  ///< what the file says of itself; empty for a folder
  InputCheck check;
  RejectCounts rejected;
  std::optional<Refusal> unusable;  ///< why nothing can be identified from it

  std::optional<Refusal> FirstProblem() const;
};

/// Seeks faults of input in a log (CheckInput) and whether it can be prepared (WhyNotPrepared).
CheckedLog CheckLog(const std::filesystem::path& path, RawChannels recorded,
                    const std::optional<LogDescription>& description, const Vehicle& vehicle);

/// The vehicle that a log describes, else one whose thrusters take 1100, 1500 and 1900 us for full
/// reverse, neutral and full forward.
Vehicle DescribedOrUsualVehicle(const std::optional<LogDescription>& description);

}  // namespace telltale
