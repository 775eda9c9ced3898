#include "telltale/service/daemon.hpp"

#include <string_view>
#include <utility>
#include <variant>

#include <spdlog/spdlog.h>

#include "telltale/client/fleet/request_reply.hpp"

namespace telltale {

Daemon::Daemon(const DaemonConfig& config, std::function<void(const std::exception&)> failed)
    : state_lock_(config.state_directory),
      storage_(config.state_directory, config.database),
      fleet_(config.vehicles, config.window),
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
                     models_.WatchForRivals();
                   },
               .received = [this](VehicleWindow& window) { quality_.PublishReceipt(window); },
               .failed = std::move(failed)}) {
  ResumeRequests();
  BeginUpkeep(config.upkeep);
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
  const Fleet::Changes changes = fleet_.Reload(vehicles);
  for (const std::string& vehicle_id : changes.added) {
    windows_.Admit(vehicle_id, *fleet_.Find(vehicle_id));
    models_.Serve(vehicle_id);
  }
  spdlog::info("serving {} vehicles: {} added, {} changed, {} no longer served", vehicles.size(),
               changes.added.size(), changes.changed.size(), changes.removed.size());
}

void Daemon::Submit(AnyRequest request) {
  if (auto* identify = std::get_if<IdentifyRequest>(&request)) {
    jobs_.Submit(std::move(*identify));
  } else if (auto* diagnose = std::get_if<DiagnoseRequest>(&request)) {
    diagnosis_jobs_.Submit(std::move(*diagnose));
  } else {
    fleet_jobs_.Submit(std::get<FleetRequest>(std::move(request)));
  }
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
void Daemon::ResumeRequests() {
  auto requests = journal_.TakeUnanswered();
  if (requests.empty()) return;
  spdlog::info("{} requests of the run before are worked on again", requests.size());
  for (AnyRequest& request : requests) Submit(std::move(request));
}

}  // namespace telltale
