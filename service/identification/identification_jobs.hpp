#pragma once

#include <functional>
#include <set>
#include <string>
#include <utility>

#include "telltale/idl/codec/daemon_config.hpp"
#include "telltale/idl/codec/messages/exchange.hpp"
#include "telltale/service/ingest/fleet.hpp"
#include "telltale/service/jobs/job_queue.hpp"
#include "telltale/service/jobs/reply_publisher.hpp"
#include "telltale/service/models/baseline_recordings.hpp"
#include "telltale/service/models/published_models.hpp"
#include "telltale/service/tasks/identification_task.hpp"
#include "telltale/service/workers/heavy_jobs.hpp"

namespace telltale {

/// Identifies vehicles from their windows on request, and publishes their models. The recording
/// behind each model is kept as the baseline of later diagnoses.
class IdentificationJobs {
 public:
  IdentificationJobs(const Fleet& fleet, PublishedModels& models, BaselineRecordings& baselines,
                     ReplyPublisher& replies, const IdentificationSettings& settings,
                     RequestJournal& journal, HeavyJobs& coverage_checks);

  /// Queues a request and returns at once. The answer goes out by ReplyPublisher.
  /// A coverage check runs in the background.
  void Submit(IdentifyRequest request, WriterHandle client);

  /// The same as a part of a refresh. `answer` gets the reply, on another thread.
  void Refresh(IdentifyRequest request, std::function<void(const IdentifyReply&)> answer) {
    jobs_.Submit(std::move(request), Urgency::kRefresh, std::move(answer));
  }

  /// As that of JobQueue.
  void GiveUp(const IdentifyRequest& request, const std::string& reason) {
    jobs_.GiveUp(request, reason);
  }

  /// False where no such request waits or runs.
  bool Cancel(const std::string& correlation_id) { return jobs_.Cancel(correlation_id); }

  /// As that of JobQueue.
  void NoteClients(const std::set<WriterHandle>& connected) { jobs_.NoteClients(connected); }

  QueueActivity Activity() const { return jobs_.Activity(); }

 private:
  IdentifyReply IdentifyAndPublish(const IdentifyRequest& request, const Computation& computation);

  Result<AssessedModel> Compute(const IdentificationTask& task, const Computation& computation);

  const Fleet& fleet_;
  PublishedModels& models_;
  BaselineRecordings& baselines_;
  const IdentificationSettings settings_;
  HeavyJobs& coverage_checks_;
  IdentificationQueue jobs_;  // last: its threads use these
};

}  // namespace telltale
