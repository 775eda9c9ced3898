#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "telltale/core/base/result.hpp"
#include "telltale/core/data/samples.hpp"
#include "telltale/core/validation/promotion.hpp"
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

/// kOk: telemetry and model are as they are to be. kWarn: something needs a look. kError: the model
/// or the window cannot be relied on. kStale: no telemetry arrives, so nothing is known of now.
/// kUnknown: from a daemon that gives no verdict.
enum class QualityVerdict { kUnknown, kOk, kWarn, kError, kStale };

inline constexpr std::array kQualityVerdicts = {QualityVerdict::kOk, QualityVerdict::kWarn,
                                                QualityVerdict::kError, QualityVerdict::kStale};

std::string_view Name(QualityVerdict verdict);

/// The order in which an operator looks: 0 ERROR, 1 STALE, 2 WARN, 3 OK, 4 unknown.
int SeverityRank(QualityVerdict verdict);

/// Why a vehicle is not OK.
struct QualityReason {
  std::string code;                                   ///< docs/reference/quality.md lists them
  QualityVerdict verdict = QualityVerdict::kUnknown;  ///< what this reason alone amounts to
  std::string text;                                   ///< for people

  bool operator==(const QualityReason&) const = default;
};

/// The newest fix of a window with the newest heading, where there is one.
struct QualityPosition {
  double latitude_deg = 0.0;
  double longitude_deg = 0.0;
  std::optional<double> heading_deg;

  bool operator==(const QualityPosition&) const = default;
};

/// By how much the stamps of a channel lie behind those of the headings, s, with 95 % bounds;
/// negative: before them. As the model has it.
struct ChannelDelay {
  Channel channel = Channel::kGnss;
  double estimate_s = 0.0;
  double lower_s = 0.0;
  double upper_s = 0.0;

  bool operator==(const ChannelDelay&) const = default;
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
  std::string proposal;  ///< what to do where something is to be done; empty: nothing
  QualityVerdict verdict = QualityVerdict::kUnknown;
  double verdict_since_unix_s = 0.0;   ///< when the verdict became this one
  std::vector<QualityReason> reasons;  ///< most serious first; none: OK
  double silent_s = 0.0;               ///< since the newest sample arrived, by the daemon's clock
  double loss_share = 0.0;             ///< of the samples sent in the last minute, [0, 1]
  double reject_share = 0.0;           ///< of those that arrived in the last minute, [0, 1]
  double drift_since_unix_s = 0.0;     ///< onset of the drift, by the daemon's clock; 0: none
  std::string drift_evidence;          ///< what shows the drift, for people; empty: no drift
  std::string drift_untested;  ///< of which changes the monitor cannot tell, and why; empty: none
  std::uint32_t coefficients = 0;  ///< of the model
  std::uint32_t identified = 0;    ///< of them, those with status ESTIMATED
  /// Median over those of half the width of the bounds, in units of the estimate; 0: none.
  double relative_half_width = 0.0;
  std::optional<Refusal> last_refusal;  ///< of the newest identification, where it was refused
  std::string diagnosis_verdict;        ///< of the last diagnosis; empty: none
  std::string diagnosis_sentence;
  double diagnosed_unix_s = 0.0;
  std::optional<QualityPosition> position;
  Promotion model_verdict;           ///< of the model when it was made
  std::vector<ChannelDelay> delays;  ///< of a model of the physical form; none: of the others
  /// Samples that arrived and were left aside, since more came than the daemon takes in.
  std::array<std::uint64_t, kChannels.size()> shed{};
  double shed_share = 0.0;         ///< of the samples that arrived in the last minute, [0, 1]
  std::uint64_t window_bytes = 0;  ///< memory of the samples held
};

}  // namespace telltale
