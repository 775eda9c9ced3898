#pragma once

#include <functional>
#include <memory>
#include <mutex>
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
#include "telltale/service/slices/slice_keeper.hpp"
#include "telltale/service/slices/slice_leases.hpp"
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

  /// Serves these vehicles from now on, or those of them whose slices it holds. A boat whose
  /// parameters have changed keeps its samples.
  void Reload(const std::vector<Vehicle>& vehicles);

 private:
  void Serve(const std::vector<Vehicle>& vehicles);
  void KeepSlices();
  void ServeHeldSlices();
  void Submit(AnyRequest request);
  bool IsForAnother(const AnyRequest& request) const;
  void Resume(std::vector<AnyRequest> requests, const char* whose);
  void BeginUpkeep(const UpkeepSettings& settings);

  // A member uses those above it. So telemetry stops first and the participant leaves the bus
  // later; the log of the bus counts into the fleet until then.
  DirectoryLock state_lock_;
  const bool alone_;  ///< it has the whole fleet
  const Storage storage_;
  const std::unique_ptr<SliceLeases> leases_;  ///< null: its writes need none
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

  std::mutex serving_mutex_;       // of what follows
  std::vector<Vehicle> vehicles_;  ///< of the whole fleet
  Slices served_slices_;
  std::optional<SliceKeeper> slice_keeper_;
};

}  // namespace telltale
