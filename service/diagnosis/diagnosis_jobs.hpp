#pragma once

#include <set>
#include <string>
#include <utility>

#include "telltale/core/diagnosis/diagnose.hpp"
#include "telltale/idl/codec/daemon_config.hpp"
#include "telltale/idl/codec/messages/exchange.hpp"
#include "telltale/service/diagnosis/published_diagnoses.hpp"
#include "telltale/service/ingest/fleet.hpp"
#include "telltale/service/jobs/job_queue.hpp"
#include "telltale/service/jobs/reply_publisher.hpp"
#include "telltale/service/models/baseline_recordings.hpp"
#include "telltale/service/models/published_models.hpp"
#include "telltale/service/monitoring/fleet_view.hpp"
#include "telltale/service/workers/heavy_jobs.hpp"

namespace telltale {

/// Compares what a vehicle has done since its newest model was made, or since that began to drift,
/// with that model, on request, and publishes the diagnoses.
class DiagnosisJobs {
 public:
  DiagnosisJobs(const Fleet& fleet, const PublishedModels& models, const FleetView& view,
                const BaselineRecordings& baselines, PublishedDiagnoses& diagnoses,
                ReplyPublisher& replies, const IdentificationSettings& settings,
                RequestJournal& journal, HeavyJobs& heavy_jobs);

  /// Queues a request and returns at once. The answer goes out by ReplyPublisher.
  void Submit(DiagnoseRequest request, WriterHandle client) {
    jobs_.Submit(std::move(request), Urgency::kInteractive, {}, client);
  }

  /// As that of JobQueue.
  void GiveUp(const DiagnoseRequest& request, const std::string& reason) {
    jobs_.GiveUp(request, reason);
  }

  /// False where no such request waits or runs.
  bool Cancel(const std::string& correlation_id) { return jobs_.Cancel(correlation_id); }

  /// As that of JobQueue.
  void NoteClients(const std::set<WriterHandle>& connected) { jobs_.NoteClients(connected); }

  QueueActivity Activity() const { return jobs_.Activity(); }

 private:
  DiagnoseReply DiagnoseAndPublish(const DiagnoseRequest& request, const Computation& computation);
  Result<DiagnosedModel> DiagnoseWindow(const PublishedModel& model, const DiagnoseRequest& request,
                                        const Computation& computation);

  const Fleet& fleet_;
  const PublishedModels& models_;
  const FleetView& view_;
  const BaselineRecordings& baselines_;
  PublishedDiagnoses& diagnoses_;
  const IdentificationSettings settings_;
  HeavyJobs& heavy_jobs_;
  DiagnosisQueue jobs_;  // last: its thread uses these
};

}  // namespace telltale
