#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "telltale/core/base/result.hpp"
#include "telltale/idl/codec/messages/diagnosis.hpp"
#include "telltale/idl/codec/messages/exchange.hpp"
#include "telltale/idl/codec/messages/quality.hpp"
#include "telltale/service/monitoring/event_log.hpp"

namespace telltale {

/// A quality with the time at which it was published.
struct TimedQuality {
  Quality quality;
  double time_unix_s = 0.0;
};

/// A request on its way and what became of it.
struct JobView {
  enum class Kind { kUnknown, kRefresh, kDiagnose };
  enum class State { kUnknown, kRunning, kPublished, kRefused, kFailed };

  std::string id;  ///< its correlation id
  std::string vehicle_id;
  Kind kind = Kind::kUnknown;
  State state = State::kUnknown;
  std::string stage;
  double fraction = 0.0;
  std::string message;
  std::vector<Refusal> refusals;
  std::uint64_t revision = 0;  ///< of the model it published
};

/// One point of a vehicle's past.
struct PastPoint {
  double time_unix_s = 0.0;
  double prediction_error = 0.0;
  std::optional<QualityPosition> position;
};

/// How many requests of a kind ended in a state.
using JobCounts = std::map<std::pair<JobView::Kind, JobView::State>, std::uint64_t>;

/// What the bus says of the fleet: the newest quality, the last hour in steps of two seconds, the
/// last refusal and diagnosis, and the requests. Safe to use from several threads.
class FleetView {
 public:
  void Take(const Quality& quality, double time_unix_s);
  /// Ends a round of qualities: all of them are taken. A vehicle whose quality is older than the
  /// round is no longer served here, and has none any more.
  void EndRound(double began_unix_s, double time_unix_s, std::vector<RejectEntry> unattributed);
  void Take(const PublishedDiagnosis& diagnosis);
  void Take(const IdentifyProgress& progress);
  void Take(const DiagnoseProgress& progress);
  void Take(const IdentifyReply& reply);
  void Take(const DiagnoseReply& reply);

  /// Of the newest identification, where it was refused.
  std::optional<Refusal> LastRefusalOf(std::string_view vehicle_id) const;
  /// Null where there is none.
  std::shared_ptr<const PublishedDiagnosis> LastDiagnosisOf(std::string_view vehicle_id) const;

  /// The onset of the drift by the vehicle's clock; nothing where there is none.
  void TakeDrift(const std::string& vehicle_id, std::optional<double> onset_s);
  std::optional<double> DriftOnsetOf(std::string_view vehicle_id) const;

  /// What the operator is to do while this revision is the newest; 0: while there is no model.
  void Advise(const std::string& vehicle_id, std::uint64_t revision, const std::string& advice);
  /// Empty where there is nothing to do.
  std::string AdviceOf(std::string_view vehicle_id, std::uint64_t revision) const;

  /// Why nothing comes from a source of the configuration; nothing where all is well.
  void TakeSource(const std::string& name, const std::optional<std::string>& fault);
  /// Of each source that has one: "name: fault".
  std::vector<std::string> SourceFaults() const;

  /// A request that is about to be queued.
  JobView Begin(JobView::Kind kind, const std::string& id, const std::string& vehicle_id);

  std::optional<TimedQuality> QualityOf(std::string_view vehicle_id) const;
  std::vector<Quality> Qualities() const;  ///< in the order of the ids
  double LastRoundUnixS() const;           ///< 0: none has ended
  std::vector<RejectEntry> Unattributed() const;
  std::vector<PastPoint> PastOf(std::string_view vehicle_id) const;
  std::vector<JobView> Jobs() const;  ///< newest first
  std::optional<JobView> JobOf(std::string_view id) const;
  JobCounts Finished() const;  ///< since the daemon started

  EventLog& events() { return events_; }

 private:
  struct Vehicle {
    std::optional<TimedQuality> quality;
    std::deque<PastPoint> past;
    std::optional<Refusal> refusal;
    std::shared_ptr<const PublishedDiagnosis> diagnosis;
    std::optional<double> drift_onset_s;
    std::string advice;
    std::uint64_t advised_revision = 0;
  };

  Vehicle& Of(const std::string& vehicle_id) { return vehicles_[vehicle_id]; }
  void Advance(JobView::Kind kind, const ExchangeProgress& progress);
  void Finish(JobView::Kind kind, const ExchangeReply& reply, std::uint64_t revision);
  JobView& Job(JobView::Kind kind, const std::string& id, const std::string& vehicle_id);

  mutable std::mutex mutex_;
  std::map<std::string, Vehicle, std::less<>> vehicles_;
  std::map<std::string, std::string> source_faults_;  ///< by name
  std::deque<JobView> jobs_;                          ///< oldest first
  JobCounts finished_;
  double last_round_unix_s_ = 0.0;
  std::vector<RejectEntry> unattributed_;
  EventLog events_;
};

}  // namespace telltale
