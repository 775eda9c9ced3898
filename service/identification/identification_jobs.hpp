#pragma once

#include <utility>

#include "telltale/core/identification/options.hpp"
#include "telltale/core/identification/progress.hpp"
#include "telltale/idl/codec/daemon_config.hpp"
#include "telltale/idl/codec/messages/exchange.hpp"
#include "telltale/service/diagnosis/baseline_recordings.hpp"
#include "telltale/service/ingest/fleet.hpp"
#include "telltale/service/jobs/job_queue.hpp"
#include "telltale/service/jobs/reply_publisher.hpp"
#include "telltale/service/models/published_models.hpp"

namespace telltale {

/// The request's wishes, and the daemon's settings and defaults for the rest.
IdentifyOptions OptionsOf(const IdentifyRequest& request, const IdentificationSettings& settings);

/// Identifies vehicles from their windows on request, and publishes their models.
class IdentificationJobs {
 public:
  IdentificationJobs(const Fleet& fleet, PublishedModels& models, BaselineRecordings& baseline,
                     ReplyPublisher& replies, const IdentificationSettings& settings);

  /// Takes a request in and returns; the answer goes out through ReplyPublisher.
  void Submit(IdentifyRequest request) { jobs_.Submit(std::move(request)); }

 private:
  IdentifyReply IdentifyAndPublish(const IdentifyRequest& request, const Progress& progress);

  const Fleet& fleet_;
  PublishedModels& models_;
  BaselineRecordings& baselines_;
  const IdentificationSettings settings_;
  JobQueue<IdentifyRequest, IdentifyProgress, IdentifyReply> jobs_;  // last: its threads use these
};

}  // namespace telltale
