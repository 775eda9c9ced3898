#include "telltale/service/daemon.hpp"

#include <string_view>
#include <utility>

#include <spdlog/spdlog.h>

namespace telltale {

Daemon::Daemon(const DaemonConfig& config, std::function<void(const std::exception&)> failed)
    : state_lock_(config.state_directory),
      fleet_(config.vehicles, config.window),
      bus_log_(spdlog::default_logger(),
               [this](std::string_view topic) { fleet_.CountUnreadable(topic); }),
      participant_(config.domain),
      models_(participant_, ModelStore(config.state_directory), fleet_),
      watcher_(participant_, view_),
      replies_(participant_),
      diagnoses_(participant_, DiagnosisStore(config.state_directory), fleet_),
      jobs_(fleet_, models_, baselines_, replies_, config.identification),
      diagnosis_jobs_(fleet_, models_, baselines_, diagnoses_, replies_, config.identification),
      quality_(participant_, fleet_, models_, view_, config.quality_period_s),
      ingest_(participant_, fleet_,
              {.identify = [this](IdentifyRequest request) { jobs_.Submit(std::move(request)); },
               .diagnose =
                   [this](DiagnoseRequest request) { diagnosis_jobs_.Submit(std::move(request)); },
               .answer_identify = [this](const IdentifyReply& reply) { replies_.Send(reply); },
               .answer_diagnose = [this](const DiagnoseReply& reply) { replies_.Send(reply); },
               .heartbeat = [this] { models_.AssertLiveliness(); },
               .received = [this](VehicleWindow& window) { quality_.PublishReceipt(window); },
               .failed = std::move(failed)}) {
  if (!config.http) return;
  web_.emplace(
      *config.http, fleet_, models_, view_,
      OrderHandlers{
          .identify = [this](IdentifyRequest request) { jobs_.Submit(std::move(request)); },
          .diagnose =
              [this](DiagnoseRequest request) { diagnosis_jobs_.Submit(std::move(request)); }});
}

}  // namespace telltale
