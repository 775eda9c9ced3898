#include "telltale/service/identification/identification_jobs.hpp"

#include <algorithm>
#include <thread>
#include <utility>

#include "telltale/core/data/recording_starts.hpp"
#include "telltale/core/identification/identify.hpp"
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
  options.coverage_check_replicates = request.coverage_check_replicates;
  if (request.recording_bias != RecordingBiasModel::kUnknown)
    options.regression.recording_bias = request.recording_bias;
  options.seed = request.seed;
  options.threads = std::max(1u, std::thread::hardware_concurrency() / settings.workers);
  return options;
}

IdentificationJobs::IdentificationJobs(const Fleet& fleet, PublishedModels& models,
                                       BaselineRecordings& baseline, ReplyPublisher& replies,
                                       const IdentificationSettings& settings)
    : fleet_(fleet),
      models_(models),
      baselines_(baseline),
      settings_(settings),
      jobs_("identification", fleet, replies, settings.workers, settings.queue_limit,
            [this](const IdentifyRequest& request, const Progress& progress) {
              return IdentifyAndPublish(request, progress);
            }) {}

IdentifyReply IdentificationJobs::IdentifyAndPublish(const IdentifyRequest& request,
                                                     const Progress& progress) {
  const IdentifyOptions options = OptionsOf(request, settings_);
  if (const auto fault = options.Validate()) {
    return ReplyTo<IdentifyReply>(request, ReplyOutcome::kFailed,
                                  fault->subject + ": " + fault->reason + "; " + fault->advice);
  }
  VehicleWindow& window = *fleet_.Find(request.vehicle_id);
  Recording recording = window.Snapshot();
  recording.starts_s = StartsAfterSilence(recording, kSilenceBetweenRecordingsS);
  const auto identification = Identify(recording, window.vehicle(), options, progress);
  if (!identification) {
    auto reply = ReplyTo<IdentifyReply>(request, ReplyOutcome::kRefused);
    reply.refusals.push_back(identification.error());
    return reply;
  }
  progress("publish", 1.0);
  auto reply = ReplyTo<IdentifyReply>(request, ReplyOutcome::kPublished);
  reply.model = models_.Publish(*identification,
                                MeasureFreeRunError(recording, window.vehicle(), *identification));
  baselines_.Keep(request.vehicle_id, reply.model->revision, recording);
  return reply;
}

}  // namespace telltale
