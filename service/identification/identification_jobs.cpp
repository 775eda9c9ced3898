#include "telltale/service/identification/identification_jobs.hpp"

#include <optional>
#include <utility>

#include "telltale/core/data/recording_starts.hpp"
#include "telltale/core/identification/identify.hpp"
#include "telltale/core/validation/promotion.hpp"
#include "telltale/core/validation/structure_choice.hpp"
#include "telltale/service/identification/identification_options.hpp"
#include "telltale/service/models/free_run_error.hpp"
#include "telltale/service/models/thin_model.hpp"

namespace telltale {
namespace {

/// What is computed of a model before it is published.
struct AssessedModel {
  Identification identification;
  Promotion promotion;
  std::optional<FreeRunError> reference_error;
};

Result<Identification> InChosenStructure(const Recording& recording, const Vehicle& vehicle,
                                         const IdentifyOptions& options, const Progress& progress) {
  auto made = IdentifyInChosenStructure(recording, vehicle, options, progress);
  if (!made) return tl::unexpected(made.error());
  return std::move(made->model);
}

Result<AssessedModel> IdentifyAndAssess(const Recording& recording, const Vehicle& vehicle,
                                        const IdentifyOptions& options, bool structure_is_left,
                                        const Progress& progress) {
  auto identification = structure_is_left ? InChosenStructure(recording, vehicle, options, progress)
                                          : Identify(recording, vehicle, options, progress);
  if (!identification) return tl::unexpected(std::move(identification).error());
  progress("comparing with constant velocity", 0.0);
  AssessedModel model{*std::move(identification), {}, {}};
  model.promotion = AssessPromotion(recording, vehicle, model.identification, options);
  model.reference_error = MeasureFreeRunError(recording, vehicle, model.identification);
  return model;
}

}  // namespace

IdentificationJobs::IdentificationJobs(const Fleet& fleet, PublishedModels& models,
                                       BaselineRecordings& baselines, ReplyPublisher& replies,
                                       const IdentificationSettings& settings,
                                       RequestJournal& journal)
    : fleet_(fleet),
      models_(models),
      baselines_(baselines),
      settings_(settings),
      jobs_(
          "identification", fleet, replies,
          {.interactive = settings.workers, .refresh = 1, .background = 1}, settings.queue_limit,
          [this](const IdentifyRequest& request, const Computation& computation) {
            return IdentifyAndPublish(request, computation);
          },
          &journal) {}

void IdentificationJobs::Submit(IdentifyRequest request, WriterHandle client) {
  const bool takes_minutes = request.coverage_check_replicates > 0;
  jobs_.Submit(std::move(request), takes_minutes ? Urgency::kBackground : Urgency::kInteractive, {},
               client);
}

IdentifyReply IdentificationJobs::IdentifyAndPublish(const IdentifyRequest& request,
                                                     const Computation& computation) {
  const IdentifyOptions options = OptionsOf(request, settings_);
  if (const auto fault = options.Validate()) {
    return ReplyTo<IdentifyReply>(request, ReplyOutcome::kFailed,
                                  fault->subject + ": " + fault->reason + "; " + fault->advice);
  }
  VehicleWindow& window = fleet_.WindowOf(request.vehicle_id);
  Recording recording = window.Snapshot();
  recording.starts_s = StartsAfterSilence(recording, kSilenceBetweenRecordingsS);
  const bool structure_is_left = LeavesStructureToData(request, settings_);
  auto model = computation([&](const Progress& progress) {
    return IdentifyAndAssess(recording, window.vehicle(), options, structure_is_left, progress);
  });
  if (!model) {
    auto reply = ReplyTo<IdentifyReply>(request, ReplyOutcome::kRefused);
    reply.refusals.push_back(model.error());
    return reply;
  }
  if (const auto sound = models_.NewestSound(request.vehicle_id)) {
    model->promotion =
        WarnIfThin(std::move(model->promotion), model->identification, window.State().fill, *sound);
  }
  computation.Report("publish", 1.0);
  auto reply = ReplyTo<IdentifyReply>(request, ReplyOutcome::kPublished);
  reply.model =
      models_.Publish(std::move(model->identification), model->reference_error, model->promotion);
  baselines_.Keep(request.vehicle_id, reply.model->revision, std::move(recording));
  return reply;
}

}  // namespace telltale
