#include "telltale/service/identification/identification_jobs.hpp"

#include <algorithm>
#include <thread>
#include <utility>

#include "telltale/core/data/recordings.hpp"
#include "telltale/service/monitoring/prediction_error.hpp"

namespace telltale {

IdentifyOptions OptionsOf(const IdentifyRequest& request, const IdentificationSettings& settings) {
  IdentifyOptions options;
  options.prepare =
      request.preset == Preset::kPaper ? PrepareOptions::Paper() : PrepareOptions::Robust();
  if (request.structure != Structure::kUnknown) options.regression.structure = request.structure;
  if (request.parameterization != Parameterization::kUnknown) {
    options.regression.parameterization = request.parameterization;
  }
  if (request.estimator != Estimator::kUnknown) {
    options.estimator = request.estimator;
  } else if (request.preset == Preset::kPaper) {
    options.estimator = Estimator::kOneStep;  // the paper's own, and the only one for its preset
  }
  if (request.dead_zone_source != DeadZoneSource::kUnknown) {
    options.dead_zone_source = request.dead_zone_source;
    options.regression.dead_zone = request.dead_zone;
  }
  options.regression.include_reverse = request.include_reverse;
  options.interval_level = settings.interval_level;
  options.bootstrap_replicates =
      request.bootstrap_replicates.value_or(settings.bootstrap_replicates);
  if (request.resampling != Resampling::kUnknown) options.resampling = request.resampling;
  if (request.resampling == Resampling::kParametric) {
    options.interval_method = IntervalMethod::kStudentized;  // which alone takes the bias out
  }
  if (request.interval_method != IntervalMethod::kUnknown) {
    options.interval_method = request.interval_method;
  }
  options.certificate_twins = request.certificate_twins;
  if (request.offsets != Offsets::kUnknown) options.regression.offsets = request.offsets;
  options.seed = request.seed;
  options.threads = std::max(1u, std::thread::hardware_concurrency() / settings.workers);
  return options;
}

IdentificationJobs::IdentificationJobs(const Fleet& fleet, PublishedModels& models,
                                       HealthyRecordings& healthy, Answers& answers,
                                       const IdentificationSettings& settings)
    : fleet_(fleet),
      models_(models),
      healthy_(healthy),
      settings_(settings),
      jobs_("identification", fleet, answers, settings.workers, settings.queue_limit,
            [this](const IdentifyRequest& request, const Progress& progress) {
              return IdentifyAndPublish(request, progress);
            }) {}

IdentifyReply IdentificationJobs::IdentifyAndPublish(const IdentifyRequest& request,
                                                     const Progress& progress) {
  const IdentifyOptions options = OptionsOf(request, settings_);
  if (const auto fault = options.Validate()) {
    return ReplyTo<IdentifyReply>(request, IdentifyOutcome::kFailed,
                                  fault->subject + ": " + fault->reason + "; " + fault->advice);
  }
  VehicleWindow& window = *fleet_.Find(request.vehicle_id);
  Recording recording = window.Snapshot();
  recording.starts_s = StartsAfterSilence(recording, kSilenceBetweenRecordingsS);
  const auto identification = Identify(recording, window.vehicle(), options, progress);
  if (!identification) {
    auto reply = ReplyTo<IdentifyReply>(request, IdentifyOutcome::kRefused);
    reply.refusals.push_back(identification.error());
    return reply;
  }
  progress("publish", 1.0);
  auto reply = ReplyTo<IdentifyReply>(request, IdentifyOutcome::kPublished);
  reply.model = models_.Publish(*identification,
                                MeasureFreeRunError(recording, window.vehicle(), *identification));
  healthy_.Keep(request.vehicle_id, reply.model->revision, recording);
  return reply;
}

}  // namespace telltale
