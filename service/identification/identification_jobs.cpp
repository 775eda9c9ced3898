#include "telltale/service/identification/identification_jobs.hpp"

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

Result<Identification> InChosenStructure(const Recording& recording, const Vehicle& vehicle,
                                         const IdentifyOptions& options, const Progress& progress) {
  auto made = IdentifyInChosenStructure(recording, vehicle, options, progress);
  if (!made) return tl::unexpected(made.error());
  return std::move(made->model);
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
          [this](const IdentifyRequest& request, const Progress& progress) {
            return IdentifyAndPublish(request, progress);
          },
          &journal) {}

void IdentificationJobs::Submit(IdentifyRequest request, WriterHandle client) {
  const bool takes_minutes = request.coverage_check_replicates > 0;
  jobs_.Submit(std::move(request), takes_minutes ? Urgency::kBackground : Urgency::kInteractive, {},
               client);
}

IdentifyReply IdentificationJobs::IdentifyAndPublish(const IdentifyRequest& request,
                                                     const Progress& progress) {
  const IdentifyOptions options = OptionsOf(request, settings_);
  if (const auto fault = options.Validate()) {
    return ReplyTo<IdentifyReply>(request, ReplyOutcome::kFailed,
                                  fault->subject + ": " + fault->reason + "; " + fault->advice);
  }
  VehicleWindow& window = fleet_.WindowOf(request.vehicle_id);
  Recording recording = window.Snapshot();
  recording.starts_s = StartsAfterSilence(recording, kSilenceBetweenRecordingsS);
  const Result<Identification> identification =
      LeavesStructureToData(request, settings_)
          ? InChosenStructure(recording, window.vehicle(), options, progress)
          : Identify(recording, window.vehicle(), options, progress);
  if (!identification) {
    auto reply = ReplyTo<IdentifyReply>(request, ReplyOutcome::kRefused);
    reply.refusals.push_back(identification.error());
    return reply;
  }
  progress("comparing with constant velocity", 0.0);
  Promotion promotion = AssessPromotion(recording, window.vehicle(), *identification, options);
  if (const auto sound = models_.NewestSound(request.vehicle_id)) {
    promotion = WarnIfThin(std::move(promotion), *identification, window.State().fill, *sound);
  }
  progress("publish", 1.0);
  auto reply = ReplyTo<IdentifyReply>(request, ReplyOutcome::kPublished);
  reply.model =
      models_.Publish(*identification,
                      MeasureFreeRunError(recording, window.vehicle(), *identification), promotion);
  baselines_.Keep(request.vehicle_id, reply.model->revision, recording);
  return reply;
}

}  // namespace telltale
