#include "telltale/service/diagnosis/diagnosis_jobs.hpp"

#include <utility>

#include "telltale/client/fleet/unix_now.hpp"
#include "telltale/service/diagnosis/diagnosis_recordings.hpp"

namespace telltale {
namespace {

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
                             const IdentificationSettings& settings, RequestJournal& journal,
                             HeavyJobs& heavy_jobs)
    : fleet_(fleet),
      models_(models),
      view_(view),
      baselines_(baselines),
      diagnoses_(diagnoses),
      settings_(settings),
      heavy_jobs_(heavy_jobs),
      jobs_(
          "diagnosis", fleet, replies, {.interactive = heavy_jobs.AtATime()}, settings.queue_limit,
          [this](const DiagnoseRequest& request, const Computation& computation) {
            return DiagnoseAndPublish(request, computation);
          },
          &journal) {}

DiagnoseReply DiagnosisJobs::DiagnoseAndPublish(const DiagnoseRequest& request,
                                                const Computation& computation) {
  if (const auto fault = OptionsOf(request, settings_).Validate()) {
    return ReplyTo<DiagnoseReply>(request, ReplyOutcome::kFailed,
                                  fault->subject + ": " + fault->reason + "; " + fault->advice);
  }
  const auto stored = models_.Latest(request.vehicle_id);
  if (!stored) return RefusedWith(request, Unmodelled(request.vehicle_id));
  auto diagnosed = DiagnoseWindow(stored->model, request, computation);
  if (!diagnosed) return RefusedWith(request, std::move(diagnosed).error());
  computation.Report("publish", 1.0);
  auto reply = ReplyTo<DiagnoseReply>(request, ReplyOutcome::kPublished);
  reply.diagnosis = {std::move(diagnosed->diagnosis), stored->model.revision, UnixNow()};
  reply.augmented = std::move(diagnosed->augmented);
  diagnoses_.Publish(*reply.diagnosis);
  return reply;
}

Result<DiagnosedModel> DiagnosisJobs::DiagnoseWindow(const PublishedModel& model,
                                                     const DiagnoseRequest& request,
                                                     const Computation& computation) {
  const std::string& vehicle_id = model.identification.vehicle_id;
  VehicleWindow& window = fleet_.WindowOf(vehicle_id);
  auto live = SelectDiagnosisRecordings(window.Snapshot(), model,
                                        baselines_.Behind(vehicle_id, model.revision),
                                        view_.DriftOnsetOf(vehicle_id));
  if (!live) return tl::unexpected(live.error());
  auto diagnosed =
      heavy_jobs_(DiagnosisTask{request, settings_, window.vehicle(), model.identification,
                                std::move(live->since), std::move(live->baseline)},
                  computation);
  if (!diagnosed) return diagnosed;
  diagnosed->diagnosis.notes.push_back(live->basis);
  if (!live->left_out.empty()) diagnosed->diagnosis.notes.push_back(live->left_out);
  return diagnosed;
}

}  // namespace telltale
