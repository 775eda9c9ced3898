#include "telltale/service/daemon.hpp"

#include <algorithm>
#include <filesystem>
#include <map>
#include <memory>
#include <set>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <variant>

#include <spdlog/spdlog.h>
#include <boost/asio/ip/host_name.hpp>

#include "telltale/client/bus/topics.hpp"
#include "telltale/client/fleet/request_reply.hpp"
#include "telltale/service/supervision/service_manager.hpp"

namespace telltale {
namespace {

std::optional<Role::Clock::duration> LeaseIfAny(const DaemonConfig& config) {
  if (!config.standby) return std::nullopt;
  return LeaseOf(*config.standby);
}

/// A lease is renewed several times before it runs out.
std::chrono::nanoseconds HeartbeatPeriodOf(const DaemonConfig& config) {
  constexpr std::chrono::seconds kOfOneAlone{1};
  return config.standby ? LeaseOf(*config.standby) / 4 : kOfOneAlone;
}

/// Of fleet requests refreshes alone take time.
bool IsKept(const AnyRequest& request) {
  const auto* fleet = std::get_if<FleetRequest>(&request);
  return fleet == nullptr || fleet->command == FleetCommand::kRefresh;
}

/// A name that no other daemon has that runs at the same time.
std::string OwnerName(const std::string& state_directory) {
  return boost::asio::ip::host_name() + ':' + std::filesystem::absolute(state_directory).string();
}

/// The leases of a daemon that keeps its fleet in a database. One that has the fleet alone takes
/// all slices, and throws where another holds one.
std::unique_ptr<SliceLeases> LeasesOf(const DaemonConfig& config, const Storage& storage) {
  if (config.database.empty()) return nullptr;
  const SliceSettings settings = config.slices.value_or(SliceSettings());
  auto leases =
      std::make_unique<SliceLeases>(storage, OwnerName(config.state_directory), settings.lease_s);
  if (config.slices) return leases;
  storage.held()->Set(leases->Claim(kFleetSlices));
  if (const std::string other = leases->OtherOwner(); !other.empty()) {
    throw std::runtime_error("database is in use by another telltaled (" + other +
                             "): stop that one, or let both have slices {}");
  }
  return leases;
}

/// Null where everything is computed here.
std::unique_ptr<OfferedJobs> OfferedTo(const std::optional<WorkerSettings>& workers,
                                       const Storage& storage) {
  if (!workers) return nullptr;
  return std::make_unique<OfferedJobs>(storage, workers->lease_s);
}

}  // namespace

Daemon::Daemon(const DaemonConfig& config, Endings endings)
    : config_(config),
      endings_(std::move(endings)),
      state_lock_(config.state_directory),
      alone_(!config.slices),
      storage_(config.state_directory, config.database,
               config.database.empty() ? Storage::Writes::kFree : Storage::Writes::kNeedLeases),
      leases_(LeasesOf(config, storage_)),
      registry_(storage_, config.vehicles, config.announced),
      fleet_(config.slices ? std::vector<Vehicle>() : registry_.Vehicles(), config.window,
             config.total_window_bytes),
      windows_(WindowStore(storage_), fleet_,
               {.window_s = config.window.duration_s,
                .save_s = config.window_save_period_s,
                .unload_after_s = config.window_unload_after_s}),
      bus_log_(spdlog::default_logger(),
               [this](std::string_view topic) { fleet_.CountUnreadable(topic); }),
      participant_(config.domain),
      role_(LeaseIfAny(config)),
      models_(participant_, ModelStore(storage_), fleet_, role_),
      watcher_(participant_, view_),
      replies_(participant_, role_),
      journal_(storage_),
      diagnoses_(participant_, DiagnosisStore(storage_)),
      retention_(
          StoreRetention(storage_, config.retention,
                         [this](const std::string& vehicle_id) { return IsInFleet(vehicle_id); })),
      offered_jobs_(OfferedTo(config.workers, storage_)),
      coverage_checks_("identification", offered_jobs_.get(),
                       config.workers.value_or(WorkerSettings())),
      heavy_diagnoses_("diagnosis", offered_jobs_.get(), config.workers.value_or(WorkerSettings())),
      jobs_(fleet_, models_, baselines_, replies_, config.identification, journal_,
            coverage_checks_),
      diagnosis_jobs_(fleet_, models_, view_, baselines_, diagnoses_, replies_,
                      config.identification, journal_, heavy_diagnoses_),
      fleet_jobs_(
          fleet_, models_, diagnoses_, replies_, journal_, [this] { return ServedSlices(); },
          {.submit = [this](const IdentifyRequest& request,
                            auto answer) { jobs_.Refresh(request, std::move(answer)); },
           .cancel =
               [this](const std::string& correlation_id) {
                 return jobs_.Cancel(correlation_id) || diagnosis_jobs_.Cancel(correlation_id);
               }}),
      quality_(participant_, role_, fleet_, models_, view_, storage_.status(),
               config.quality_period_s),
      fail_over_(MakeFailOver()),
      ingest_(participant_, fleet_, config.require_partition, config.intake,
              {.identify = [this](IdentifyRequest request,
                                  WriterHandle client) { Take(std::move(request), client); },
               .diagnose = [this](DiagnoseRequest request,
                                  WriterHandle client) { Take(std::move(request), client); },
               .fleet = [this](FleetRequest request,
                               WriterHandle client) { Take(std::move(request), client); },
               .answer_identify = [this](const IdentifyReply& reply) { replies_.Send(reply); },
               .answer_diagnose = [this](const DiagnoseReply& reply) { replies_.Send(reply); },
               .answer_fleet = [this](const FleetReply& reply) { replies_.Send(reply); },
               .heartbeat = [this](bool has_received) { Heartbeat(has_received); },
               .clients =
                   [this](const std::set<WriterHandle>& connected) {
                     jobs_.NoteClients(connected);
                     diagnosis_jobs_.NoteClients(connected);
                   },
               .heartbeat_period = HeartbeatPeriodOf(config),
               .received = [this](VehicleWindow& window) { quality_.PublishReceipt(window); },
               .failed = endings_.failed}) {
  if (fail_over_) {
    fail_over_->Start();
  } else {
    TakeOver(ModelQos(), false);
  }
  KeepSlices();
  HearAnnouncements();
  if (config.http) Open(*config.http);
  if (ServiceManager::Listens()) supervision_.emplace([this] { return Activity(); });
}

void Daemon::Open(const HttpSettings& http) {
  web_.emplace(
      http, fleet_, models_, diagnoses_, view_, [this] { return Activity(); },
      OrderHandlers{.serves = [this] { return role_.Serves(); },
                    .identify = [this](IdentifyRequest request) { Submit(std::move(request)); },
                    .diagnose = [this](DiagnoseRequest request) { Submit(std::move(request)); },
                    .rollback =
                        [this](const std::string& vehicle_id, std::uint64_t revision) {
                          return models_.Rollback(vehicle_id, revision);
                        }});
}

/// A boat that was refused or is no longer configured may be admitted now.
void Daemon::Reload(const DaemonConfig& config) {
  const std::lock_guard lock(serving_mutex_);
  registry_.Configure(config.vehicles, config.announced);
  announcements_->HearAgain();
  Serve(registry_.Vehicles());
}

std::size_t Daemon::FleetSize() {
  const std::lock_guard lock(serving_mutex_);
  return registry_.Vehicles().size();
}

bool Daemon::IsInFleet(const std::string& vehicle_id) {
  const std::lock_guard lock(serving_mutex_);
  return registry_.Contains(vehicle_id);
}

void Daemon::HearAnnouncements() {
  announcements_.emplace(
      participant_, fleet_, config_.require_partition,
      Announcements::Handlers{.announced =
                                  [this](const Vehicle& vehicle) {
                                    const std::lock_guard lock(serving_mutex_);
                                    return registry_.Announce(vehicle,
                                                              VehicleRegistry::Clock::now());
                                  },
                              .retired =
                                  [this](const std::string& vehicle_id) {
                                    const std::lock_guard lock(serving_mutex_);
                                    return registry_.Retire(vehicle_id);
                                  },
                              .settle = [this](bool changed) { SettleAnnounced(changed); }});
}

/// Boats whose announcements cannot be stored now are served and are stored later.
void Daemon::SettleAnnounced(bool changed) {
  const std::lock_guard lock(serving_mutex_);
  if (changed) Serve(registry_.Vehicles());
  if (registry_.HasUnstored()) registry_.Store();
}

void Daemon::ServeHeldSlices() {
  const std::lock_guard lock(serving_mutex_);
  const Slices held = storage_.held()->Get();
  std::set<int> gained;
  for (const auto& [slice, fence] : held) {
    const auto served = served_slices_.find(slice);
    if (served == served_slices_.end() || served->second != fence) gained.insert(slice);
  }
  served_slices_ = held;
  spdlog::info("this daemon holds {} of {} slices, {} of them newly", held.size(), kFleetSlices,
               gained.size());
  try {
    registry_.ReadStored();
    Serve(registry_.Vehicles());
    Resume(journal_.TakeUnanswered(gained), "of the daemons before");
  } catch (const DatabaseError& error) {
    spdlog::error("not all is taken over: {}", error.what());
  }
  is_ready_ = true;
}

/// The leases that the writes of this daemon need; one without a part of the fleet takes all.
void Daemon::KeepSlices() {
  if (!leases_) return;
  if (alone_) served_slices_ = storage_.held()->Get();
  slice_keeper_.emplace(*leases_, *storage_.held(), alone_ ? FleetShare::kAll : FleetShare::kPart,
                        [this] { ServeHeldSlices(); });
}

/// Where their boats are being read from the database it waits until that is done.
SliceSet Daemon::ServedSlices() {
  if (alone_) return kAllSlices;
  const std::lock_guard lock(serving_mutex_);
  return SetOf(served_slices_);
}

/// Those of the vehicles that are this daemon's. The caller holds serving_mutex_.
void Daemon::Serve(const std::vector<Vehicle>& vehicles) {
  std::vector<Vehicle> mine;
  std::set<std::string, std::less<>> elsewhere;
  for (const Vehicle& vehicle : vehicles) {
    const bool held = !storage_.held() || storage_.held()->FenceOf(vehicle.vehicle_id);
    held ? mine.push_back(vehicle) : void(elsewhere.insert(vehicle.vehicle_id));
  }
  const Fleet::Changes changes = fleet_.Reload(mine, std::move(elsewhere));
  for (const std::string& vehicle_id : changes.removed) {
    if (fleet_.IsServedElsewhere(vehicle_id)) models_.Withdraw(vehicle_id);
  }
  for (const std::string& vehicle_id : changes.added) {
    windows_.Admit(vehicle_id, *fleet_.Find(vehicle_id));
    models_.Serve(vehicle_id);
    diagnoses_.Serve(vehicle_id);
  }
  spdlog::info("serving {} vehicles: {} added, {} changed, {} no longer served", mine.size(),
               changes.added.size(), changes.changed.size(), changes.removed.size());
}

/// Null where this daemon serves alone.
std::unique_ptr<FailOver> Daemon::MakeFailOver() {
  if (!config_.standby) return nullptr;
  return std::make_unique<FailOver>(
      participant_, *config_.standby, TermStore(storage_), role_, heard_,
      Mirror::Into{fleet_, models_, diagnoses_, baselines_},
      FailOver::Handlers{.take_over =
                             [this](std::int32_t ownership_strength, bool succeeds) {
                               TakeOver(WithOwnershipStrength(
                                            WithLease(ModelQos(), LeaseOf(*config_.standby)),
                                            ownership_strength),
                                        succeeds);
                             },
                         .step_down = [this] { StepDown(); }});
}

/// The daemon has the role to serve already. `succeeds`: another daemon has served before.
void Daemon::TakeOver(const Qos& model_contract, bool succeeds) {
  models_.BeginPublishing(model_contract);
  diagnoses_.BeginPublishing(fleet_);
  TakeUpRequests(succeeds);
  BeginUpkeep();
  sources_.emplace(participant_, config_.sources, view_);
  is_ready_ = alone_;
}

/// The role is given up already. What was published while the other daemon could not hear it goes
/// out to it before this one ends.
void Daemon::StepDown() {
  constexpr auto kLongestWait = std::chrono::seconds(5);
  sources_.reset();
  if (!models_.AwaitReceipt(kLongestWait)) spdlog::warn("not every reader has the newest models");
  endings_.replaced();
}

void Daemon::Heartbeat(bool has_received) {
  if (fail_over_) fail_over_->Heartbeat(has_received);
  models_.AssertLiveliness();
  if (alone_) models_.WatchForRivals();
}

/// A request from the bus.
void Daemon::Take(AnyRequest request, WriterHandle client) {
  if (!heard_.Note(request, HeardRequests::Clock::now())) Submit(std::move(request), client);
}

void Daemon::Submit(AnyRequest request, WriterHandle client) {
  if (IsForAnother(request)) return;
  if (auto* identify = std::get_if<IdentifyRequest>(&request)) {
    jobs_.Submit(std::move(*identify), client);
  } else if (auto* diagnose = std::get_if<DiagnoseRequest>(&request)) {
    diagnosis_jobs_.Submit(std::move(*diagnose), client);
  } else {
    fleet_jobs_.Submit(std::get<FleetRequest>(std::move(request)));
  }
}

/// Whether it is about one boat that another daemon serves, which hears of it too.
bool Daemon::IsForAnother(const AnyRequest& request) const {
  if (const auto* fleet = std::get_if<FleetRequest>(&request)) {
    return fleet->vehicle_ids.size() == 1 && fleet_.IsServedElsewhere(fleet->vehicle_ids.front());
  }
  const auto* identify = std::get_if<IdentifyRequest>(&request);
  return fleet_.IsServedElsewhere(
      identify != nullptr ? identify->vehicle_id : std::get<DiagnoseRequest>(request).vehicle_id);
}

void Daemon::BeginUpkeep() {
  const UpkeepSettings& settings = config_.upkeep;
  if (settings.refresh == RefreshMode::kOff && !settings.diagnose_on_drift) return;
  upkeep_.emplace(settings, fleet_, models_, view_,
                  Upkeep::Orders{.refresh =
                                     [this](const std::vector<std::string>& vehicle_ids) {
                                       FleetRequest request;
                                       request.correlation_id = NewCorrelationId();
                                       request.command = FleetCommand::kRefresh;
                                       request.vehicle_ids = vehicle_ids;
                                       Submit(std::move(request));
                                     },
                                 .diagnose =
                                     [this](const std::string& vehicle_id) {
                                       DiagnoseRequest request;
                                       request.correlation_id = NewCorrelationId();
                                       request.vehicle_id = vehicle_id;
                                       view_.Begin(JobView::Kind::kDiagnose, request.correlation_id,
                                                   vehicle_id);
                                       Submit(std::move(request));
                                     }});
}

DaemonActivity Daemon::Activity() const {
  DaemonActivity activity;
  activity.serves = role_.Serves();
  activity.is_ready = is_ready_ || (fail_over_ && fail_over_->HasFollowed());
  activity.vehicles = fleet_.windows().size();
  activity.ingest_silence = ingest_.Silence();
  activity.queues = {jobs_.Activity(), diagnosis_jobs_.Activity()};
  if (offered_jobs_) {
    activity.heavy_jobs = {coverage_checks_.Activity(), heavy_diagnoses_.Activity()};
  }
  activity.stores = {{"models", models_.Written()},
                     {"windows", windows_.Written()},
                     {"requests", journal_.Written()}};
  activity.windows = windows_.Activity();
  activity.unwritten_requests = journal_.Waiting();
  activity.retention = retention_.Activity();
  activity.received = ingest_.Received();
  activity.matches = ingest_.Matches();
  activity.matches.push_back({kContract<telltale_wire_Model>.topic, models_.Matched()});
  activity.matches.push_back({kContract<telltale_wire_Quality>.topic, quality_.Matched()});
  return activity;
}

/// A daemon that was killed has left requests without an answer. Where another has served in the
/// meantime, that one has answered them, but for those that somebody still asks for.
void Daemon::TakeUpRequests(bool succeeds) {
  auto own = alone_ ? journal_.TakeUnanswered() : std::vector<UnansweredRequest>();
  std::map<std::string, int> own_attempts;
  for (const auto& [request, attempts] : own) own_attempts[CorrelationIdOf(request)] = attempts;
  if (!succeeds) Resume(std::move(own), "of the run before");
  std::vector<UnansweredRequest> heard;
  for (auto& [request, begun] : heard_.TakeUnanswered(HeardRequests::Clock::now())) {
    const auto known = own_attempts.extract(CorrelationIdOf(request));
    const int attempts = begun && IsKept(request) ? journal_.CountAttemptOfAnother(request)
                         : known.empty()          ? 0
                                                  : known.mapped();
    heard.push_back({std::move(request), attempts});
  }
  if (succeeds) {
    for (const auto& [correlation_id, attempts] : own_attempts) journal_.Drop(correlation_id);
  }
  Resume(std::move(heard), "that were heard");
}

/// What has ended the daemon again and again would end it for ever.
void Daemon::Resume(std::vector<UnansweredRequest> requests, const char* whose) {
  constexpr int kMostAttempts = 3;
  if (requests.empty()) return;
  spdlog::info("{} requests {} are worked on again", requests.size(), whose);
  for (UnansweredRequest& taken : requests) {
    taken.attempts < kMostAttempts ? Submit(std::move(taken.request))
                                   : GiveUp(taken.request, taken.attempts);
  }
}

void Daemon::GiveUp(const AnyRequest& request, int attempts) {
  const std::string reason =
      "the daemon has ended each of the " + std::to_string(attempts) +
      " times that it took it up again; its log and its service manager say how";
  if (const auto* identify = std::get_if<IdentifyRequest>(&request)) {
    jobs_.GiveUp(*identify, reason);
  } else if (const auto* diagnose = std::get_if<DiagnoseRequest>(&request)) {
    diagnosis_jobs_.GiveUp(*diagnose, reason);
  } else {
    fleet_jobs_.GiveUp(std::get<FleetRequest>(request), reason);
  }
}

}  // namespace telltale
