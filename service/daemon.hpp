#pragma once

#include <functional>

#include "telltale/client/bus/bus_log.hpp"
#include "telltale/client/bus/participant.hpp"
#include "telltale/idl/codec/daemon_config.hpp"
#include "telltale/service/diagnosis/baseline_recordings.hpp"
#include "telltale/service/diagnosis/diagnosis_jobs.hpp"
#include "telltale/service/diagnosis/published_diagnoses.hpp"
#include "telltale/service/identification/identification_jobs.hpp"
#include "telltale/service/ingest/fleet.hpp"
#include "telltale/service/ingest/ingest.hpp"
#include "telltale/service/jobs/reply_publisher.hpp"
#include "telltale/service/models/published_models.hpp"
#include "telltale/service/monitoring/quality_monitor.hpp"

namespace telltale {

/// The daemon at work, from construction to destruction. Throws when the domain cannot be joined or
/// the state directory not be used.
class Daemon {
 public:
  /// `failed` is called, from another thread, when telemetry can no longer be taken in.
  Daemon(const DaemonConfig& config, std::function<void(const std::exception&)> failed);

 private:
  // In the order of what stands on what: telemetry stops first, then the bus is left, and last goes
  // what the bus's log counts into.
  Fleet fleet_;
  BusLog bus_log_;
  Participant participant_;
  PublishedModels models_;
  ReplyPublisher replies_;
  BaselineRecordings baselines_;
  PublishedDiagnoses diagnoses_;
  IdentificationJobs jobs_;
  DiagnosisJobs diagnosis_jobs_;
  QualityMonitor quality_;
  Ingest ingest_;
};

}  // namespace telltale
