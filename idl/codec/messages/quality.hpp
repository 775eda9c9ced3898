#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "telltale/core/data/samples.hpp"
#include "telltale/core/vessel/model_structure.hpp"

namespace telltale {

/// Rejected samples of one channel and one reason. Reasons are the names of RejectReason, and those
/// of samples that reach no window.
struct RejectEntry {
  std::string channel;
  std::string reason;
  std::uint64_t count = 0;

  bool operator==(const RejectEntry&) const = default;
};

/// The entries of all channels and reasons with a count above zero.
std::vector<RejectEntry> RejectEntries(const RejectCounts& counts);

/// Stands in place of a vehicle id where samples name no vehicle that the daemon serves. No vehicle
/// id may contain this character.
inline constexpr std::string_view kUnattributed = "*";

/// A live estimate with its standard error, by one-step least squares over the newest rows.
/// The estimate is indicative: it has the attenuation bias of that estimator, and no multiple of
/// the standard error is a bound.
struct IndicativeCoefficient {
  Equation equation = Equation::kUnknown;
  std::string regressor;
  std::string symbol;
  double estimate = 0.0;
  double standard_error = 0.0;
  std::string unit;

  bool operator==(const IndicativeCoefficient&) const = default;
};

/// The state of a vehicle's telemetry and of its model.
struct Quality {
  std::string vehicle_id;  ///< or kUnattributed
  std::uint64_t sequence_number = 0;
  double window_s = 0.0;     ///< time span of the window
  double window_fill = 0.0;  ///< share of the configured span, [0, 1]
  double gnss_rate_hz = 0.0;
  double heading_rate_hz = 0.0;
  double thrusters_rate_hz = 0.0;
  std::uint64_t lost = 0;  ///< gaps in the sequence numbers, all channels
  std::uint64_t accepted = 0;
  std::vector<RejectEntry> rejected;
  std::optional<std::uint64_t> model_revision;
  double model_age_s = 0.0;
  double prediction_error = 0.0;  ///< free-run error over 5 s, in units of that when identified
  double drift = 0.0;             ///< running change of prediction_error per evaluation
  std::vector<IndicativeCoefficient> indicative;  ///< static structure; the estimable ones
  std::uint64_t indicative_rows = 0;              ///< prepared rows behind the live estimates
  std::string proposal;  ///< what to do where the model no longer fits; empty: nothing
};

}  // namespace telltale
