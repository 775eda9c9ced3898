#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "telltale/client/bus/bus_log.hpp"
#include "telltale/client/bus/participant.hpp"
#include "telltale/idl/codec/daemon_config.hpp"
#include "telltale/service/diagnosis/diagnosis_jobs.hpp"
#include "telltale/service/diagnosis/published_diagnoses.hpp"
#include "telltale/service/fleet_requests/fleet_jobs.hpp"
#include "telltale/service/identification/identification_jobs.hpp"
#include "telltale/service/ingest/fleet.hpp"
#include "telltale/service/ingest/ingest.hpp"
#include "telltale/service/jobs/reply_publisher.hpp"
#include "telltale/service/jobs/request_journal.hpp"
#include "telltale/service/models/baseline_recordings.hpp"
#include "telltale/service/models/published_models.hpp"
#include "telltale/service/monitoring/fleet_view.hpp"
#include "telltale/service/monitoring/fleet_watcher.hpp"
#include "telltale/service/monitoring/quality_publisher.hpp"
#include "telltale/service/storage/directory_lock.hpp"
#include "telltale/service/storage/storage.hpp"
#include "telltale/service/upkeep/upkeep.hpp"
#include "telltale/service/web/web_server.hpp"
#include "telltale/service/windows/window_archive.hpp"

namespace telltale {

/// The daemon, which serves its vehicles from construction to destruction. Throws where it cannot
/// join the domain, or use the state directory or the database.
class Daemon {
 public:
  /// Another thread calls `failed` when the daemon can no longer receive telemetry.
  Daemon(const DaemonConfig& config, std::function<void(const std::exception&)> failed);

  /// Serves these vehicles from now on. A boat whose parameters have changed keeps its samples.
  void Reload(const std::vector<Vehicle>& vehicles);

 private:
  void Submit(AnyRequest request);
  void ResumeRequests();
  void BeginUpkeep(const UpkeepSettings& settings);

  // A member uses those above it. So telemetry stops first and the participant leaves the bus
  // later; the log of the bus counts into the fleet until then.
  DirectoryLock state_lock_;
  const Storage storage_;
  Fleet fleet_;
  WindowArchive windows_;
  BusLog bus_log_;
  Participant participant_;
  PublishedModels models_;
  FleetView view_;
  FleetWatcher watcher_;
  ReplyPublisher replies_;
  RequestJournal journal_;
  BaselineRecordings baselines_;
  PublishedDiagnoses diagnoses_;
  IdentificationJobs jobs_;
  DiagnosisJobs diagnosis_jobs_;
  FleetJobs fleet_jobs_;
  QualityPublisher quality_;
  Ingest ingest_;
  std::optional<Upkeep> upkeep_;
  std::optional<WebServer> web_;
};

}  // namespace telltale
