#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "telltale/core/base/result.hpp"
#include "telltale/core/data/preparation.hpp"
#include "telltale/core/data/samples.hpp"
#include "telltale/core/diagnosis/report/diagnosis.hpp"
#include "telltale/core/identification/identification.hpp"
#include "telltale/core/identification/options.hpp"

namespace telltale {

/// One telemetry sample as it travels: whose it is and its place in that channel's stream, which is
/// how a receiver sees loss. vehicle_id borrows from the wire struct or from the caller.
template <class Sample>
struct Telemetry {
  std::string_view vehicle_id;
  std::uint64_t sequence_number = 0;
  Sample sample;
};

/// An identification that has been given its place in the vehicle's history.
struct PublishedModel {
  Identification identification;
  std::uint64_t revision = 0;  ///< from 1, counts up by one per vehicle
  double published_unix_s = 0.0;
};

/// Asks the daemon to identify a vehicle from its window. What is left unknown or unset is the
/// daemon's to choose.
struct IdentifyRequest {
  std::string correlation_id;  ///< 1..64 characters as in vehicle ids; the same id is answered once
  std::string vehicle_id;
  Structure structure = Structure::kUnknown;
  Parameterization parameterization = Parameterization::kUnknown;
  Estimator estimator = Estimator::kUnknown;
  Preset preset = Preset::kUnknown;
  std::optional<std::uint32_t> bootstrap_replicates;  ///< 0 or [100, 100000]
  std::uint64_t seed = 1;
  DeadZoneSource dead_zone_source = DeadZoneSource::kUnknown;
  DeadZone dead_zone;            ///< when given
  bool include_reverse = false;  ///< fit rows of the RR region too
  Resampling resampling = Resampling::kUnknown;
  IntervalMethod interval_method = IntervalMethod::kUnknown;
  std::uint32_t coverage_check_replicates = 0;  ///< 0 (none) or [10, 1000]
  RecordingBiasModel recording_bias =
      RecordingBiasModel::kUnknown;  ///< of what the window holds between long silences
};

/// How far the daemon is with a request.
struct ExchangeProgress {
  std::string correlation_id;
  std::string vehicle_id;
  std::string stage;
  double fraction = 0.0;  ///< [0, 1]
};

/// kPublished: what was asked for, also on its own topic. kRefused: the window cannot answer.
/// kFailed: anything else, in words.
enum class ReplyOutcome { kUnknown, kPublished, kRefused, kFailed };

std::string_view Name(ReplyOutcome outcome);

/// What every reply says.
struct ExchangeReply {
  std::string correlation_id;
  std::string vehicle_id;
  ReplyOutcome outcome = ReplyOutcome::kUnknown;
  std::string message;            ///< what failed; empty otherwise
  std::vector<Refusal> refusals;  ///< why, when refused
  double elapsed_s = 0.0;
};

struct IdentifyProgress : ExchangeProgress {};

struct IdentifyReply : ExchangeReply {
  std::optional<PublishedModel> model;  ///< when published
};

/// A diagnosis of a vehicle's window against a published model.
struct PublishedDiagnosis {
  Diagnosis diagnosis;
  std::uint64_t model_revision = 0;
  double published_unix_s = 0.0;
};

/// Asks the daemon to diagnose a vehicle's window.
struct DiagnoseRequest {
  std::string correlation_id;  ///< as of an IdentifyRequest
  std::string vehicle_id;
  bool refit = false;
  std::vector<std::string> without;  ///< effects to leave out
  std::uint64_t seed = 1;
};

struct DiagnoseProgress : ExchangeProgress {};

struct DiagnoseReply : ExchangeReply {
  std::optional<PublishedDiagnosis> diagnosis;  ///< when published
  /// The model identified again with the effects that are likely, where any is. It is no revision:
  /// the vehicle's model stays what it is.
  std::optional<Identification> augmented;
};

/// Rejected samples as a monitor shows them. Reasons are RejectReason names and those of a sample
/// that never reached a window.
struct RejectEntry {
  std::string channel;
  std::string reason;
  std::uint64_t count = 0;

  bool operator==(const RejectEntry&) const = default;
};

/// Stands for a vehicle id where samples name no vehicle that the daemon serves. It cannot be one.
inline constexpr std::string_view kUnattributed = "*";

/// A live estimate with its error bar, from one-step least squares over the newest rows. Indicative
/// alone: it shares the attenuation of that estimator, and no multiple of its error is a bound.
struct IndicativeCoefficient {
  Equation equation = Equation::kUnknown;
  std::string regressor;
  std::string symbol;
  double estimate = 0.0;
  double standard_error = 0.0;
  std::string unit;

  bool operator==(const IndicativeCoefficient&) const = default;
};

/// How well a vehicle's telemetry and model are doing.
struct Quality {
  std::string vehicle_id;  ///< or kUnattributed
  std::uint64_t sequence_number = 0;
  double window_s = 0.0;     ///< time span held
  double window_fill = 0.0;  ///< share of the configured span, [0, 1]
  double gnss_rate_hz = 0.0;
  double heading_rate_hz = 0.0;
  double thrusters_rate_hz = 0.0;
  std::uint64_t lost = 0;  ///< gaps in the sequence numbers, all channels
  std::uint64_t accepted = 0;
  std::vector<RejectEntry> rejected;
  std::optional<std::uint64_t> model_revision;
  double model_age_s = 0.0;
  double prediction_error = 0.0;  ///< free-run error over 5 s now, in units of that when identified
  double drift = 0.0;             ///< running change of prediction_error per evaluation
  std::vector<IndicativeCoefficient> indicative;  ///< static structure; those that can be told
  std::uint64_t indicative_rows = 0;              ///< prepared rows taken in so far
  std::string proposal;  ///< what to do where the model no longer fits; empty: nothing
};

std::vector<RejectEntry> RejectEntries(const RejectCounts& counts);

}  // namespace telltale
