#include "telltale/service/tasks/identification_options.hpp"

#include <algorithm>
#include <thread>

namespace telltale {
namespace {

/// Options that the physical form does not take.
bool AsksForFreeCoefficients(const IdentifyRequest& request) {
  return request.parameterization != Parameterization::kUnknown ||
         request.estimator != Estimator::kUnknown || request.preset == Preset::kPaper ||
         request.dead_zone_source != DeadZoneSource::kUnknown || request.include_reverse ||
         request.recording_bias != RecordingBiasModel::kUnknown || request.bootstrap_replicates ||
         request.resampling != Resampling::kUnknown ||
         request.interval_method != IntervalMethod::kUnknown ||
         request.coverage_check_replicates > 0;
}

void SetModelOptions(const IdentifyRequest& request, const IdentificationSettings& settings,
                     IdentifyOptions& options) {
  options.prepare =
      request.preset == Preset::kPaper ? PrepareOptions::Paper() : PrepareOptions::Robust();
  if (request.structure != Structure::kUnknown) {
    options.regression.structure = request.structure;
  } else if (settings.structure && !AsksForFreeCoefficients(request)) {
    options.regression.structure = *settings.structure;
  }
  if (request.parameterization != Parameterization::kUnknown) {
    options.regression.parameterization = request.parameterization;
  }
  if (request.estimator != Estimator::kUnknown) {
    options.estimator = request.estimator;
  } else if (request.preset == Preset::kPaper) {
    options.estimator = Estimator::kOneStep;  // the paper's; its preset has no other
  }
  if (request.dead_zone_source != DeadZoneSource::kUnknown) {
    options.dead_zone_source = request.dead_zone_source;
    options.regression.dead_zone = request.dead_zone;
  }
  options.regression.include_reverse = request.include_reverse;
  if (request.recording_bias != RecordingBiasModel::kUnknown) {
    options.regression.recording_bias = request.recording_bias;
  }
}

void SetBoundsOptions(const IdentifyRequest& request, const IdentificationSettings& settings,
                      IdentifyOptions& options) {
  options.interval_level = settings.interval_level;
  options.bootstrap_replicates =
      request.bootstrap_replicates.value_or(settings.bootstrap_replicates);
  if (request.resampling != Resampling::kUnknown) options.resampling = request.resampling;
  if (request.resampling == Resampling::kParametric) {
    options.interval_method =
        IntervalMethod::kStudentized;  // the one method that corrects the bias
  }
  if (request.interval_method != IntervalMethod::kUnknown) {
    options.interval_method = request.interval_method;
  }
  options.coverage_check_replicates = request.coverage_check_replicates;
}

}  // namespace

bool LeavesStructureToData(const IdentifyRequest& request, const IdentificationSettings& settings) {
  return request.structure == Structure::kUnknown && !settings.structure &&
         !AsksForFreeCoefficients(request);
}

IdentifyOptions OptionsOf(const IdentifyRequest& request, const IdentificationSettings& settings) {
  IdentifyOptions options;
  SetModelOptions(request, settings, options);
  SetBoundsOptions(request, settings, options);
  options.seed = request.seed;
  options.threads = std::max(1u, std::thread::hardware_concurrency() / settings.workers);
  return options;
}

}  // namespace telltale
