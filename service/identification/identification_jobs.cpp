#include "telltale/service/identification/identification_jobs.hpp"

#include <utility>

#include "telltale/core/data/recording_starts.hpp"
#include "telltale/service/models/thin_model.hpp"
#include "telltale/service/tasks/identification_options.hpp"

namespace telltale {
namespace {

/// It takes minutes.
bool HasCoverageCheck(const IdentifyRequest& request) {
  return request.coverage_check_replicates > 0;
}

}  // namespace

IdentificationJobs::IdentificationJobs(const Fleet& fleet, PublishedModels& models,
                                       BaselineRecordings& baselines, ReplyPublisher& replies,
                                       const IdentificationSettings& settings,
                                       RequestJournal& journal, HeavyJobs& coverage_checks)
    : fleet_(fleet),
      models_(models),
      baselines_(baselines),
      settings_(settings),
      coverage_checks_(coverage_checks),
      jobs_(
          "identification", fleet, replies,
          {.interactive = settings.workers, .refresh = 1, .background = coverage_checks.AtATime()},
          settings.queue_limit,
          [this](const IdentifyRequest& request, const Computation& computation) {
            return IdentifyAndPublish(request, computation);
          },
          &journal) {}

void IdentificationJobs::Submit(IdentifyRequest request, WriterHandle client) {
  const Urgency urgency = HasCoverageCheck(request) ? Urgency::kBackground : Urgency::kInteractive;
  jobs_.Submit(std::move(request), urgency, {}, client);
}

IdentifyReply IdentificationJobs::IdentifyAndPublish(const IdentifyRequest& request,
                                                     const Computation& computation) {
  if (const auto fault = OptionsOf(request, settings_).Validate()) {
    return ReplyTo<IdentifyReply>(request, ReplyOutcome::kFailed,
                                  fault->subject + ": " + fault->reason + "; " + fault->advice);
  }
  VehicleWindow& window = fleet_.WindowOf(request.vehicle_id);
  IdentificationTask task{request, settings_, window.vehicle(), window.Snapshot()};
  task.recording.starts_s = StartsAfterSilence(task.recording, kSilenceBetweenRecordingsS);
  auto model = Compute(task, computation);
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
  baselines_.Keep(request.vehicle_id, reply.model->revision, std::move(task.recording));
  return reply;
}

Result<AssessedModel> IdentificationJobs::Compute(const IdentificationTask& task,
                                                  const Computation& computation) {
  if (HasCoverageCheck(task.request)) return coverage_checks_(task, computation);
  return computation(
      [&task](const Progress& progress) { return telltale::Compute(task, progress); });
}

}  // namespace telltale
