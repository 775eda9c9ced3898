#pragma once

#include <utility>

#include "telltale/core/identification/progress.hpp"
#include "telltale/idl/codec/daemon_config.hpp"
#include "telltale/idl/codec/messages/exchange.hpp"
#include "telltale/service/ingest/fleet.hpp"
#include "telltale/service/jobs/job_queue.hpp"
#include "telltale/service/jobs/reply_publisher.hpp"
#include "telltale/service/models/baseline_recordings.hpp"
#include "telltale/service/models/published_models.hpp"

namespace telltale {

/// Identifies vehicles from their windows on request, and publishes their models. The recording
/// behind each model is kept as the baseline of later diagnoses.
class IdentificationJobs {
 public:
  IdentificationJobs(const Fleet& fleet, PublishedModels& models, BaselineRecordings& baselines,
                     ReplyPublisher& replies, const IdentificationSettings& settings);

  /// Queues a request and returns at once. The answer goes out by ReplyPublisher.
  /// A coverage check runs in the background.
  void Submit(IdentifyRequest request);

 private:
  IdentifyReply IdentifyAndPublish(const IdentifyRequest& request, const Progress& progress);

  const Fleet& fleet_;
  PublishedModels& models_;
  BaselineRecordings& baselines_;
  const IdentificationSettings settings_;
  JobQueue<IdentifyRequest, IdentifyProgress, IdentifyReply> jobs_;  // last: its threads use these
};

}  // namespace telltale
