#include "telltale/core/identification/options.hpp"

#include <string>

#include "telltale/core/base/range.hpp"

namespace telltale {
namespace {

constexpr const char* kOptionsSubject = "identification";

/// Of a count that is 0 (none) or within a range.
std::optional<Refusal> ReplicatesRefusal(const char* field, std::size_t count, double least,
                                         double most) {
  if (count == 0) return std::nullopt;
  auto refusal = OutOfRange(kOptionsSubject, field, static_cast<double>(count), least, most);
  if (refusal) refusal->advice += ", or to 0 for none";
  return refusal;
}

std::optional<Refusal> LimitRefusal(const DeadZone& limits) {
  if (auto refusal = OutOfRange("dead_zone", "forward", limits.forward, 0.0, kWidestDeadZone)) {
    return refusal;
  }
  return OutOfRange("dead_zone", "reverse", limits.reverse, -kWidestDeadZone, 0.0);
}

std::optional<Refusal> EstimatorRefusal(const IdentifyOptions& options) {
  if (options.regression.recording_bias == RecordingBiasModel::kUnknown) {
    return Refusal{"recording_bias", "is unset",
                   "choose SHARED, PER_RECORDING or PER_RECORDING_NORTH_EAST"};
  }
  if (options.estimator == Estimator::kOneStep || options.estimator == Estimator::kOutputError) {
    if (options.regression.recording_bias != RecordingBiasModel::kShared) {
      return Refusal{
          "recording_bias",
          "of each recording is not estimated by " + std::string(Name(*options.estimator)),
          "choose WEAK_IV, or a SHARED recording bias"};
    }
  }
  if (options.estimator == Estimator::kOneStep) return std::nullopt;
  if (options.estimator == Estimator::kUnknown) {
    return Refusal{"estimator", "is UNKNOWN",
                   "choose WEAK_IV, OUTPUT_ERROR or ONE_STEP, or leave it unset"};
  }
  if (options.prepare.preset != Preset::kRobust) {
    return Refusal{"estimator",
                   "WEAK_IV, from which OUTPUT_ERROR starts, needs motion and commands filtered by "
                   "one kernel",
                   "choose the robust preset, or ONE_STEP"};
  }
  return ReplicatesRefusal("parametric_replicates", options.parametric_replicates, 8.0, 1000.0);
}

}  // namespace

std::string_view Name(DeadZoneSource source) {
  switch (source) {
    case DeadZoneSource::kGiven: return "GIVEN";
    case DeadZoneSource::kIdentified: return "IDENTIFIED";
    case DeadZoneSource::kUnknown: break;
  }
  return "UNKNOWN";
}

IdentifyOptions IdentifyOptions::OneStep() {
  IdentifyOptions options;
  options.estimator = Estimator::kOneStep;
  options.weak_iv.delays = false;  // the paper takes the clocks for one
  return options;
}

std::optional<Refusal> IdentifyOptions::Validate() const {
  if (auto refusal = prepare.Validate()) return refusal;
  if (auto refusal = excitation.Validate()) return refusal;
  if (regression.structure == Structure::kUnknown) {
    return Refusal{"structure", "is unset",
                   "choose STATIC_QUADRATIC, FIRST_ORDER_DYNAMIC or FOSSEN"};
  }
  if (regression.parameterization == Parameterization::kUnknown) {
    return Refusal{"parameterization", "is unset", "choose PROPELLER or PAPER"};
  }
  if (dead_zone_source == DeadZoneSource::kUnknown) {
    return Refusal{"dead_zone_source", "is unset", "choose GIVEN or IDENTIFIED"};
  }
  if (auto refusal = LimitRefusal(regression.dead_zone)) return refusal;
  if (auto refusal = EstimatorRefusal(*this)) return refusal;
  if (auto refusal = OutOfRange(kOptionsSubject, "interval_level", interval_level, 0.5, 0.999)) {
    return refusal;
  }
  if (auto refusal =
          ReplicatesRefusal("bootstrap_replicates", bootstrap_replicates, 100.0, 100000.0))
    return refusal;
  if (auto refusal = OutOfRange(kOptionsSubject, "posterior_draws",
                                static_cast<double>(posterior_draws), 100.0, 100000.0)) {
    return refusal;
  }
  if (auto refusal =
          ReplicatesRefusal("coverage_check_replicates", coverage_check_replicates, 10.0, 1000.0))
    return refusal;
  if (resampling == Resampling::kUnknown) {
    return Refusal{"resampling", "is unset", "choose SEGMENTS, MOVING_BLOCKS or PARAMETRIC"};
  }
  if (resampling == Resampling::kParametric && prepare.preset != Preset::kRobust) {
    return Refusal{"resampling", "PARAMETRIC simulates what the robust preset has prepared",
                   "choose the robust preset, or SEGMENTS"};
  }
  if (interval_method == IntervalMethod::kUnknown) {
    return Refusal{"interval_method", "is unset", "choose PERCENTILE, STUDENTIZED or BCA"};
  }
  if (auto refusal =
          OutOfRange(kOptionsSubject, "threads", static_cast<double>(threads), 1.0, 256.0)) {
    return refusal;
  }
  return std::nullopt;
}

}  // namespace telltale
