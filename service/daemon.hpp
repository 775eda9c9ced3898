#pragma once

#include <functional>

#include "bus/log_sink.hpp"
#include "bus/participant.hpp"
#include "codec/daemon_config.hpp"
#include "diagnosis/diagnosis_jobs.hpp"
#include "diagnosis/healthy_recordings.hpp"
#include "diagnosis/published_diagnoses.hpp"
#include "identification/answers.hpp"
#include "identification/identification_jobs.hpp"
#include "ingest/fleet.hpp"
#include "ingest/ingest.hpp"
#include "models/published_models.hpp"
#include "monitoring/quality_monitor.hpp"

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
  Answers answers_;
  HealthyRecordings healthy_;
  PublishedDiagnoses diagnoses_;
  IdentificationJobs jobs_;
  DiagnosisJobs diagnosis_jobs_;
  QualityMonitor quality_;
  Ingest ingest_;
};

}  // namespace telltale
