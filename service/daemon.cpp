#include "telltale/service/daemon.hpp"

#include <string_view>
#include <utility>
#include <variant>

#include <spdlog/spdlog.h>

#include "telltale/client/bus/topics.hpp"
#include "telltale/client/fleet/request_reply.hpp"

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

}  // namespace

Daemon::Daemon(const DaemonConfig& config, Endings endings)
    : config_(config),
      endings_(std::move(endings)),
      state_lock_(config.state_directory),
      fleet_(config.vehicles, config.window),
      windows_(WindowStore(config.state_directory), fleet_, config.window.duration_s,
               config.window_save_period_s),
      bus_log_(spdlog::default_logger(),
               [this](std::string_view topic) { fleet_.CountUnreadable(topic); }),
      participant_(config.domain),
      role_(LeaseIfAny(config)),
      models_(participant_, ModelStore(config.state_directory), fleet_, role_),
      watcher_(participant_, view_),
      replies_(participant_, role_),
      journal_(config.state_directory),
      diagnoses_(participant_, DiagnosisStore(config.state_directory)),
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
      quality_(participant_, role_, fleet_, models_, view_, config.quality_period_s),
      fail_over_(MakeFailOver()),
      ingest_(participant_, fleet_, config.require_partition,
              {.identify = [this](IdentifyRequest request) { Take(std::move(request)); },
               .diagnose = [this](DiagnoseRequest request) { Take(std::move(request)); },
               .fleet = [this](FleetRequest request) { Take(std::move(request)); },
               .answer_identify = [this](const IdentifyReply& reply) { replies_.Send(reply); },
               .answer_diagnose = [this](const DiagnoseReply& reply) { replies_.Send(reply); },
               .answer_fleet = [this](const FleetReply& reply) { replies_.Send(reply); },
               .heartbeat = [this](bool has_received) { Heartbeat(has_received); },
               .heartbeat_period = HeartbeatPeriodOf(config),
               .received = [this](VehicleWindow& window) { quality_.PublishReceipt(window); },
               .failed = endings_.failed}),
      sources_(participant_, config.sources, view_) {
  if (fail_over_) {
    fail_over_->Start();
  } else {
    TakeOver(ModelQos(), false);
  }
  if (!config.http) return;
  web_.emplace(
      *config.http, fleet_, models_, view_, [this] { return Activity(); },
      OrderHandlers{.serves = [this] { return role_.Serves(); },
                    .identify = [this](IdentifyRequest request) { Submit(std::move(request)); },
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

/// Null where this daemon serves alone.
std::unique_ptr<FailOver> Daemon::MakeFailOver() {
  if (!config_.standby) return nullptr;
  return std::make_unique<FailOver>(
      participant_, *config_.standby, role_, heard_,
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
  ResumeRequests(succeeds);
  for (AnyRequest& request : heard_.TakeUnanswered(HeardRequests::Clock::now())) {
    Submit(std::move(request));
  }
  BeginUpkeep();
}

/// The role is given up already. What was published while the other daemon could not hear it goes
/// out to it before this one ends.
void Daemon::StepDown() {
  constexpr auto kLongestWait = std::chrono::seconds(5);
  if (!models_.AwaitReceipt(kLongestWait)) spdlog::warn("not every reader has the newest models");
  endings_.replaced();
}

void Daemon::Heartbeat(bool has_received) {
  if (fail_over_) fail_over_->Heartbeat(has_received);
  models_.AssertLiveliness();
  models_.WatchForRivals();
}

/// A request from the bus.
void Daemon::Take(AnyRequest request) {
  if (!heard_.Note(request, HeardRequests::Clock::now())) Submit(std::move(request));
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
  activity.queues = {jobs_.Activity(), diagnosis_jobs_.Activity()};
  activity.stores = {{"models", models_.Written()},
                     {"windows", windows_.Written()},
                     {"requests", journal_.Written()}};
  activity.received = ingest_.Received();
  activity.matches = ingest_.Matches();
  activity.matches.push_back({kContract<telltale_wire_Model>.topic, models_.Matched()});
  activity.matches.push_back({kContract<telltale_wire_Quality>.topic, quality_.Matched()});
  return activity;
}

/// A daemon that was killed has left requests without an answer. Where another has served in the
/// meantime, that one has answered them.
void Daemon::ResumeRequests(bool succeeds) {
  auto requests = journal_.TakeUnanswered();
  if (requests.empty()) return;
  if (succeeds) {
    for (const AnyRequest& request : requests) journal_.Drop(CorrelationIdOf(request));
    return;
  }
  spdlog::info("{} requests of the run before are worked on again", requests.size());
  for (AnyRequest& request : requests) Submit(std::move(request));
}

}  // namespace telltale
