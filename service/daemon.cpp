#include "telltale/service/daemon.hpp"

#include <filesystem>
#include <memory>
#include <set>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <variant>

#include <spdlog/spdlog.h>
#include <boost/asio/ip/host_name.hpp>

#include "telltale/client/fleet/request_reply.hpp"

namespace telltale {

namespace {

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

}  // namespace

Daemon::Daemon(const DaemonConfig& config, std::function<void(const std::exception&)> failed)
    : state_lock_(config.state_directory),
      alone_(!config.slices),
      storage_(config.state_directory, config.database,
               config.database.empty() ? Storage::Writes::kFree : Storage::Writes::kNeedLeases),
      leases_(LeasesOf(config, storage_)),
      fleet_(config.slices ? std::vector<Vehicle>() : config.vehicles, config.window),
      windows_(WindowStore(storage_), fleet_, config.window.duration_s,
               config.window_save_period_s),
      bus_log_(spdlog::default_logger(),
               [this](std::string_view topic) { fleet_.CountUnreadable(topic); }),
      participant_(config.domain),
      models_(participant_, ModelStore(storage_), fleet_),
      watcher_(participant_, view_),
      replies_(participant_),
      journal_(storage_),
      diagnoses_(participant_, DiagnosisStore(storage_), fleet_),
      jobs_(fleet_, models_, baselines_, replies_, config.identification, journal_),
      diagnosis_jobs_(fleet_, models_, view_, baselines_, diagnoses_, replies_,
                      config.identification, journal_),
      fleet_jobs_(fleet_, models_, replies_, journal_,
                  {.submit = [this](const IdentifyRequest& request,
                                    auto answer) { jobs_.Refresh(request, std::move(answer)); },
                   .cancel =
                       [this](const std::string& correlation_id) {
                         return jobs_.Cancel(correlation_id) ||
                                diagnosis_jobs_.Cancel(correlation_id);
                       }}),
      quality_(participant_, fleet_, models_, view_, storage_.status(), config.quality_period_s),
      ingest_(participant_, fleet_,
              {.identify = [this](IdentifyRequest request) { Submit(std::move(request)); },
               .diagnose = [this](DiagnoseRequest request) { Submit(std::move(request)); },
               .fleet = [this](FleetRequest request) { Submit(std::move(request)); },
               .answer_identify = [this](const IdentifyReply& reply) { replies_.Send(reply); },
               .answer_diagnose = [this](const DiagnoseReply& reply) { replies_.Send(reply); },
               .answer_fleet = [this](const FleetReply& reply) { replies_.Send(reply); },
               .heartbeat =
                   [this] {
                     models_.AssertLiveliness();
                     if (alone_) models_.WatchForRivals();
                   },
               .received = [this](VehicleWindow& window) { quality_.PublishReceipt(window); },
               .failed = std::move(failed)}),
      vehicles_(config.vehicles) {
  if (alone_) Resume(journal_.TakeUnanswered(), "of the run before");
  BeginUpkeep(config.upkeep);
  KeepSlices();
  if (!config.http) return;
  web_.emplace(
      *config.http, fleet_, models_, view_,
      OrderHandlers{.identify = [this](IdentifyRequest request) { Submit(std::move(request)); },
                    .diagnose = [this](DiagnoseRequest request) { Submit(std::move(request)); },
                    .rollback =
                        [this](const std::string& vehicle_id, std::uint64_t revision) {
                          return models_.Rollback(vehicle_id, revision);
                        }});
}

void Daemon::Reload(const std::vector<Vehicle>& vehicles) {
  const std::lock_guard lock(serving_mutex_);
  vehicles_ = vehicles;
  Serve(vehicles_);
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
    Serve(vehicles_);
    Resume(journal_.TakeUnanswered(gained), "of the daemons before");
  } catch (const DatabaseError& error) {
    spdlog::error("not all is taken over: {}", error.what());
  }
}

/// The leases that the writes of this daemon need; one without a part of the fleet takes all.
void Daemon::KeepSlices() {
  if (!leases_) return;
  if (alone_) served_slices_ = storage_.held()->Get();
  slice_keeper_.emplace(*leases_, *storage_.held(), alone_ ? FleetShare::kAll : FleetShare::kPart,
                        [this] { ServeHeldSlices(); });
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

void Daemon::Submit(AnyRequest request) {
  if (IsForAnother(request)) return;
  if (auto* identify = std::get_if<IdentifyRequest>(&request)) {
    jobs_.Submit(std::move(*identify));
  } else if (auto* diagnose = std::get_if<DiagnoseRequest>(&request)) {
    diagnosis_jobs_.Submit(std::move(*diagnose));
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

void Daemon::BeginUpkeep(const UpkeepSettings& settings) {
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

/// A daemon that was killed has left requests without an answer.
void Daemon::Resume(std::vector<AnyRequest> requests, const char* whose) {
  if (requests.empty()) return;
  spdlog::info("{} requests {} are worked on again", requests.size(), whose);
  for (AnyRequest& request : requests) Submit(std::move(request));
}

}  // namespace telltale
