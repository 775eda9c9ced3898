#pragma once

#include <optional>
#include <string>
#include <vector>

#include "telltale/idl/codec/messages/quality.hpp"
#include "telltale/service/monitoring/recent_telemetry.hpp"

namespace telltale {

/// Where a vehicle stops being OK. docs/reference/quality.md states the same values.
struct VerdictLimits {
  double silent_s = 10.0;      ///< a silence that is longer is a fault
  double loss_share = 0.05;    ///< of the samples sent in the last minute
  double shed_share = 0.05;    ///< of the samples of the last minute
  double reject_share = 0.05;  ///< of the samples of the last minute: WARN
  double useless_share = 0.5;  ///< of the samples of the last minute: ERROR
  std::uint64_t faults = 5;    ///< stamps off the clock, or readings of a stuck sensor, in a minute
  double error_ratio = 3.0;    ///< of a drifting model, in units of its normal error: ERROR
};

/// Why the vehicle is not OK, most serious first; none where it is. Requires the fields of the
/// quality that tell of telemetry, model and last refusal. `store_fault` is why something is not
/// saved now.
std::vector<QualityReason> ReasonsOf(const Quality& quality, const LastMinute& last,
                                     const std::optional<std::string>& store_fault = {},
                                     const VerdictLimits& limits = {});

/// Adds the faults of sources, "name: fault", to the reasons of a vehicle that is silent or of
/// which a channel is: they may be why. Most serious first stays so.
void AddSourceFaults(const std::vector<std::string>& faults, std::vector<QualityReason>& reasons);

/// The verdict that the reasons amount to. Without telemetry nothing is known of now: STALE.
QualityVerdict VerdictOf(const std::vector<QualityReason>& reasons);

}  // namespace telltale
