#include "diagnosis/diagnosis_jobs.hpp"

#include <algorithm>
#include <chrono>
#include <thread>

#include <spdlog/spdlog.h>

#include "codec/wire.hpp"
#include "data/preparation.hpp"
#include "diagnosis/diagnose.hpp"
#include "diagnosis/live_case.hpp"

namespace telltale {
namespace {

constexpr std::size_t kDiagnosedAtOnce = 1;  // each uses all the processors it is given

double UnixSecondsNow() {
  return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
}

DiagnoseOptions DiagnoseOptionsOf(const DiagnoseRequest& request,
                                  const IdentificationSettings& settings) {
  DiagnoseOptions options;
  options.refit = request.refit;
  options.without = request.without;
  options.seed = request.seed;
  options.threads = std::max(1u, std::thread::hardware_concurrency() / settings.workers);
  return options;
}

}  // namespace

DiagnosisJobs::DiagnosisJobs(const Participant& participant, const Fleet& fleet,
                             const PublishedModels& models, const HealthyRecordings& healthy,
                             Answers& answers, const IdentificationSettings& settings)
    : fleet_(fleet),
      models_(models),
      healthy_(healthy),
      settings_(settings),
      writer_(participant),
      jobs_("diagnosis", fleet, answers, kDiagnosedAtOnce, settings.queue_limit,
            [this](const DiagnoseRequest& request, const Progress& progress) {
              return DiagnoseAndPublish(request, progress);
            }) {}

DiagnoseReply DiagnosisJobs::DiagnoseAndPublish(const DiagnoseRequest& request,
                                                const Progress& progress) {
  const DiagnoseOptions options = DiagnoseOptionsOf(request, settings_);
  if (const auto fault = options.Validate()) {
    return ReplyTo<DiagnoseReply>(request, IdentifyOutcome::kFailed,
                                  fault->subject + ": " + fault->reason + "; " + fault->advice);
  }
  auto diagnosis = DiagnoseWindow(request, options, progress);
  if (!diagnosis) {
    auto reply = ReplyTo<DiagnoseReply>(request, IdentifyOutcome::kRefused);
    reply.refusals.push_back(std::move(diagnosis).error());
    return reply;
  }
  progress("publish", 1.0);
  Announce(*diagnosis);
  auto reply = ReplyTo<DiagnoseReply>(request, IdentifyOutcome::kPublished);
  reply.diagnosis = *std::move(diagnosis);
  return reply;
}

Result<PublishedDiagnosis> DiagnosisJobs::DiagnoseWindow(const DiagnoseRequest& request,
                                                         const DiagnoseOptions& options,
                                                         const Progress& progress) const {
  const auto stored = models_.Latest(request.vehicle_id);
  if (!stored) {
    return Refuse(request.vehicle_id, "has no model yet that its window could be held against",
                  "identify it first: telltale identify --vehicle-id " + request.vehicle_id);
  }
  const PublishedModel& model = stored->model;
  VehicleWindow& window = *fleet_.Find(request.vehicle_id);
  progress("preparing data", 0.0);
  const auto live =
      CaseOf(window.Snapshot(), model, healthy_.Behind(request.vehicle_id, model.revision));
  if (!live) return tl::unexpected(live.error());
  PrepareOptions preparation;
  preparation.sampling_period_s = model.identification.sampling_period_s;
  const auto since = Prepare(live->since, window.vehicle(), preparation);
  if (!since) return tl::unexpected(since.error());
  std::vector<PreparedDataset> references;
  if (live->healthy) {
    auto healthy = Prepare(*live->healthy, window.vehicle(), preparation);
    if (!healthy) return tl::unexpected(std::move(healthy).error());
    references.push_back(*std::move(healthy));
  }
  auto diagnosed =
      Diagnose(*since, references, model.identification, request.vehicle_id, options, progress);
  if (!diagnosed) return tl::unexpected(std::move(diagnosed).error());
  diagnosed->diagnosis.notes.push_back(live->basis);
  return PublishedDiagnosis{std::move(diagnosed->diagnosis), model.revision, UnixSecondsNow()};
}

void DiagnosisJobs::Announce(const PublishedDiagnosis& diagnosis) {
  const std::string& vehicle_id = diagnosis.diagnosis.vehicle_id;
  spdlog::info("diagnosis of {}: {}", vehicle_id, diagnosis.diagnosis.sentence);
  try {
    if (!writer_.Write(Encode(diagnosis))) {
      spdlog::warn("a stalled client held up the diagnosis of {}", vehicle_id);
    }
  } catch (const BusError& error) {
    spdlog::error("the diagnosis of {} is not published: {}", vehicle_id, error.what());
  }
}

}  // namespace telltale
