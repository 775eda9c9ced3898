#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
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
#include "telltale/service/monitoring/daemon_activity.hpp"
#include "telltale/service/monitoring/fleet_view.hpp"
#include "telltale/service/monitoring/fleet_watcher.hpp"
#include "telltale/service/monitoring/quality_publisher.hpp"
#include "telltale/service/registry/announcements.hpp"
#include "telltale/service/registry/vehicle_registry.hpp"
#include "telltale/service/retention/retention.hpp"
#include "telltale/service/role.hpp"
#include "telltale/service/slices/slice_keeper.hpp"
#include "telltale/service/slices/slice_leases.hpp"
#include "telltale/service/sources/live_sources.hpp"
#include "telltale/service/standby/fail_over.hpp"
#include "telltale/service/standby/heard_requests.hpp"
#include "telltale/service/storage/directory_lock.hpp"
#include "telltale/service/storage/storage.hpp"
#include "telltale/service/supervision/memory_return.hpp"
#include "telltale/service/supervision/supervision.hpp"
#include "telltale/service/upkeep/upkeep.hpp"
#include "telltale/service/web/web_server.hpp"
#include "telltale/service/windows/window_archive.hpp"
#include "telltale/service/workers/heavy_jobs.hpp"
#include "telltale/service/workers/offered_jobs.hpp"

namespace telltale {

/// The daemon, which takes in the telemetry of its vehicles from construction to destruction. It
/// serves from the start, or once no other daemon does where the configuration has a standby.
/// Throws where it cannot join the domain, or use the state directory or the database.
class Daemon {
 public:
  /// Both are called on other threads, at most once.
  struct Endings {
    std::function<void(const std::exception&)> failed;  ///< telemetry can no longer be received
    std::function<void()> replaced;  ///< another daemon serves: this one has to be made anew
  };

  Daemon(const DaemonConfig& config, Endings endings);

  /// Serves the vehicles of this configuration from now on, and those that announce themselves to
  /// it, or those of them whose slices it holds. A boat whose parameters have changed keeps its
  /// samples. Of the configuration nothing else counts.
  void Reload(const DaemonConfig& config);

  /// How many vehicles the whole fleet has.
  std::size_t FleetSize();

 private:
  std::unique_ptr<FailOver> MakeFailOver();
  void TakeOver(const Qos& model_contract, bool succeeds);
  void StepDown();
  void Serve(const std::vector<Vehicle>& vehicles);
  void HearAnnouncements();
  void SettleAnnounced(bool changed);
  void KeepSlices();
  void ServeHeldSlices();
  SliceSet ServedSlices();
  void Take(AnyRequest request, WriterHandle client);
  void Submit(AnyRequest request, WriterHandle client = kNoClient);
  bool IsInFleet(const std::string& vehicle_id);
  bool IsForAnother(const AnyRequest& request) const;
  void TakeUpRequests(bool succeeds);
  void Resume(std::vector<UnansweredRequest> requests, const char* whose);
  void GiveUp(const AnyRequest& request, int attempts);
  void BeginUpkeep();
  void Open(const HttpSettings& http);
  void Heartbeat(bool has_received);
  DaemonActivity Activity() const;

  // A member uses those above it. So telemetry stops first and the participant leaves the bus
  // later; the log of the bus counts into the fleet until then.
  const DaemonConfig config_;
  const Endings endings_;
  DirectoryLock state_lock_;
  const bool alone_;  ///< it has the whole fleet
  const Storage storage_;
  const std::unique_ptr<SliceLeases> leases_;  ///< null: its writes need none
  std::mutex serving_mutex_;                   // of the two that follow
  VehicleRegistry registry_;                   ///< of the whole fleet
  Slices served_slices_;
  Fleet fleet_;
  WindowArchive windows_;
  BusLog bus_log_;
  Participant participant_;
  Role role_;
  HeardRequests heard_;
  PublishedModels models_;
  FleetView view_;
  FleetWatcher watcher_;
  ReplyPublisher replies_;
  RequestJournal journal_;
  BaselineRecordings baselines_;
  PublishedDiagnoses diagnoses_;
  Retention retention_;
  const std::unique_ptr<OfferedJobs> offered_jobs_;  ///< null: it has no workers
  HeavyJobs coverage_checks_;
  HeavyJobs heavy_diagnoses_;
  IdentificationJobs jobs_;
  DiagnosisJobs diagnosis_jobs_;
  FleetJobs fleet_jobs_;
  QualityPublisher quality_;
  std::optional<Upkeep> upkeep_;               ///< while it serves
  std::optional<LiveSources> sources_;         ///< likewise: a standby would publish all twice
  std::atomic<bool> is_ready_ = false;         ///< it serves, with the boats of its first slices
  const std::unique_ptr<FailOver> fail_over_;  ///< null: this daemon serves alone
  Ingest ingest_;
  std::optional<Announcements> announcements_;
  std::optional<WebServer> web_;
  std::optional<SliceKeeper> slice_keeper_;
  MemoryReturn memory_return_;
  std::optional<Supervision> supervision_;  ///< while a service manager listens
};

}  // namespace telltale
