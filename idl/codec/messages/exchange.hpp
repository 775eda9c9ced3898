#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "telltale/core/base/result.hpp"
#include "telltale/core/identification/options.hpp"
#include "telltale/idl/codec/messages/diagnosis.hpp"
#include "telltale/idl/codec/messages/model.hpp"

namespace telltale {

/// The part that all requests share.
struct ExchangeRequest {
  std::string correlation_id;  ///< 1..64 characters of a vehicle id; an id is worked on once
  std::string vehicle_id;
  double deadline_s = 0.0;  ///< from receipt; later nobody waits for the answer. 0: no deadline

  bool operator==(const ExchangeRequest&) const = default;
};

/// Asks the daemon to identify a vehicle from its window. The daemon chooses each option that is
/// unknown or unset.
struct IdentifyRequest : ExchangeRequest {
  Structure structure = Structure::kUnknown;
  Parameterization parameterization = Parameterization::kUnknown;
  Estimator estimator = Estimator::kUnknown;
  Preset preset = Preset::kUnknown;
  std::optional<std::uint32_t> bootstrap_replicates;  ///< 0 or [100, 100000]
  std::uint64_t seed = 1;
  DeadZoneSource dead_zone_source = DeadZoneSource::kUnknown;
  DeadZone dead_zone;            ///< where the source is kGiven
  bool include_reverse = false;  ///< also fits rows of the RR region
  Resampling resampling = Resampling::kUnknown;
  IntervalMethod interval_method = IntervalMethod::kUnknown;
  std::uint32_t coverage_check_replicates = 0;  ///< 0 (no check) or [10, 1000]
  /// Of the recordings in the window, which long silences separate.
  RecordingBiasModel recording_bias = RecordingBiasModel::kUnknown;

  bool operator==(const IdentifyRequest&) const = default;
};

/// Asks the daemon to diagnose a vehicle's window.
struct DiagnoseRequest : ExchangeRequest {
  bool refit = false;                ///< lets the coefficients follow the window
  std::vector<std::string> without;  ///< effects to leave out of the library
  std::uint64_t seed = 1;

  bool operator==(const DiagnoseRequest&) const = default;
};

/// Whether both ask for the same, whoever asks and until when.
template <class Request>
bool AskTheSame(const Request& one, Request other) {
  other.correlation_id = one.correlation_id;
  other.deadline_s = one.deadline_s;
  return one == other;
}

/// The progress of the daemon with a request.
struct ExchangeProgress {
  std::string correlation_id;
  std::string vehicle_id;
  std::string stage;
  double fraction = 0.0;  ///< [0, 1]
};

struct IdentifyProgress : ExchangeProgress {};
struct DiagnoseProgress : ExchangeProgress {};

/// kPublished: the result is in the reply and on its own topic.
/// kRefused: the window cannot answer; the refusals say why.
/// kFailed: anything else; the message says what.
/// kAnswered: the answer is in the reply, and nothing is published for it.
enum class ReplyOutcome { kUnknown, kPublished, kRefused, kFailed, kAnswered };

std::string_view Name(ReplyOutcome outcome);

/// The part that all replies share.
struct ExchangeReply {
  std::string correlation_id;
  std::string vehicle_id;
  ReplyOutcome outcome = ReplyOutcome::kUnknown;
  std::string message;            ///< empty unless failed
  std::vector<Refusal> refusals;  ///< empty unless refused
  double elapsed_s = 0.0;
  double retry_after_s = 0.0;  ///< above 0: failed because the daemon is busy; ask again after this
};

struct IdentifyReply : ExchangeReply {
  std::optional<PublishedModel> model;  ///< given when published
};

struct DiagnoseReply : ExchangeReply {
  std::optional<PublishedDiagnosis> diagnosis;  ///< given when published
  /// The model re-identified with the likely effects; none where no effect is likely. It is not a
  /// revision: the vehicle's published model does not change.
  std::optional<Identification> augmented;
};

}  // namespace telltale
