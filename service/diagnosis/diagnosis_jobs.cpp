#include "telltale/service/diagnosis/diagnosis_jobs.hpp"

#include <algorithm>
#include <thread>
#include <utility>

#include "telltale/client/fleet/unix_now.hpp"
#include "telltale/core/data/preparation.hpp"
#include "telltale/core/diagnosis/diagnose.hpp"
#include "telltale/service/diagnosis/diagnosis_recordings.hpp"

namespace telltale {
namespace {

constexpr Workers kWorkers{.interactive = 1};  // one diagnosis uses all processors that it is given

DiagnoseOptions DiagnoseOptionsOf(const DiagnoseRequest& request,
                                  const IdentificationSettings& settings) {
  DiagnoseOptions options;
  options.refit = request.refit;
  options.without = request.without;
  options.seed = request.seed;
  options.threads = std::max(1u, std::thread::hardware_concurrency() / settings.workers);
  return options;
}

Refusal Unmodelled(const std::string& vehicle_id) {
  return {vehicle_id, "has no model to compare its window with",
          "identify it first: telltale identify --vehicle-id " + vehicle_id};
}

DiagnoseReply RefusedWith(const DiagnoseRequest& request, Refusal refusal) {
  auto reply = ReplyTo<DiagnoseReply>(request, ReplyOutcome::kRefused);
  reply.refusals.push_back(std::move(refusal));
  return reply;
}

}  // namespace

DiagnosisJobs::DiagnosisJobs(const Fleet& fleet, const PublishedModels& models,
                             const FleetView& view, const BaselineRecordings& baselines,
                             PublishedDiagnoses& diagnoses, ReplyPublisher& replies,
                             const IdentificationSettings& settings, RequestJournal& journal)
    : fleet_(fleet),
      models_(models),
      view_(view),
      baselines_(baselines),
      diagnoses_(diagnoses),
      settings_(settings),
      jobs_(
          "diagnosis", fleet, replies, kWorkers, settings.queue_limit,
          [this](const DiagnoseRequest& request, const Computation& computation) {
            return DiagnoseAndPublish(request, computation);
          },
          &journal) {}

DiagnoseReply DiagnosisJobs::DiagnoseAndPublish(const DiagnoseRequest& request,
                                                const Computation& computation) {
  const DiagnoseOptions options = DiagnoseOptionsOf(request, settings_);
  if (const auto fault = options.Validate()) {
    return ReplyTo<DiagnoseReply>(request, ReplyOutcome::kFailed,
                                  fault->subject + ": " + fault->reason + "; " + fault->advice);
  }
  const auto stored = models_.Latest(request.vehicle_id);
  if (!stored) return RefusedWith(request, Unmodelled(request.vehicle_id));
  auto diagnosed = DiagnoseWindow(stored->model, options, computation);
  if (!diagnosed) return RefusedWith(request, std::move(diagnosed).error());
  computation.Report("publish", 1.0);
  auto reply = ReplyTo<DiagnoseReply>(request, ReplyOutcome::kPublished);
  reply.diagnosis = {std::move(diagnosed->diagnosis), stored->model.revision, UnixNow()};
  reply.augmented = std::move(diagnosed->augmented);
  diagnoses_.Publish(*reply.diagnosis);
  return reply;
}

Result<DiagnosedModel> DiagnosisJobs::DiagnoseWindow(const PublishedModel& model,
                                                     const DiagnoseOptions& options,
                                                     const Computation& computation) const {
  const std::string& vehicle_id = model.identification.vehicle_id;
  VehicleWindow& window = fleet_.WindowOf(vehicle_id);
  computation.Report("preparing data", 0.0);
  const auto live = SelectDiagnosisRecordings(window.Snapshot(), model,
                                              baselines_.Behind(vehicle_id, model.revision),
                                              view_.DriftOnsetOf(vehicle_id));
  if (!live) return tl::unexpected(live.error());
  PrepareOptions preparation;
  preparation.sampling_period_s = model.identification.sampling_period_s;
  const auto since = Prepare(live->since, window.vehicle(), preparation);
  if (!since) return tl::unexpected(since.error());
  std::vector<PreparedDataset> references;
  if (live->baseline) {
    auto baseline = Prepare(*live->baseline, window.vehicle(), preparation);
    if (!baseline) return tl::unexpected(std::move(baseline).error());
    references.push_back(*std::move(baseline));
  }
  auto diagnosed = computation([&](const Progress& progress) {
    return Diagnose(*since, references, model.identification, vehicle_id, options, progress);
  });
  if (!diagnosed) return diagnosed;
  diagnosed->diagnosis.notes.push_back(live->basis);
  if (!live->left_out.empty()) diagnosed->diagnosis.notes.push_back(live->left_out);
  return diagnosed;
}

}  // namespace telltale
