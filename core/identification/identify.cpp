#include "telltale/core/identification/identify.hpp"

#include "telltale/core/base/version.hpp"
#include "telltale/core/data/preparation.hpp"
#include "telltale/core/estimation/regression/dead_zone_estimate.hpp"
#include "telltale/core/identification/clock_alignment.hpp"
#include "telltale/core/identification/coverage_check.hpp"
#include "telltale/core/identification/equation_estimates.hpp"
#include "telltale/core/identification/estimator_selection.hpp"
#include "telltale/core/identification/experiment_design.hpp"
#include "telltale/core/identification/one_step_estimate.hpp"
#include "telltale/core/identification/output_error_estimate.hpp"
#include "telltale/core/identification/physical_estimate.hpp"
#include "telltale/core/identification/simulation_parameters.hpp"
#include "telltale/core/identification/weak_iv_estimate.hpp"

namespace telltale {
namespace {

Refusal UndeterminedLimit(const char* side, const DeadZoneLimit& limit, double kept) {
  const std::string reason =
      limit.contrast > kLeastContrast
          ? "the best value lies at the edge of the allowed range, so it "
            "stands for something else"
          : "the data do not determine it: every allowed value explains them equally";
  return {"dead zone, " + std::string(side), reason + "; " + std::to_string(kept) + " is kept",
          "record commands that pass slowly through neutral on this side, or give the limit"};
}

/// The dead zone by the data. A limit that the data do not determine stays as given, with a
/// refusal.
DeadZone IdentifyDeadZone(const PreparedDataset& dataset, const IdentifyOptions& options,
                          std::vector<Refusal>& refusals) {
  DeadZone limits = options.regression.dead_zone;
  const auto estimate =
      EstimateDeadZone(dataset, options.regression, options.excitation, options.threads);
  if (!estimate) return limits;  // the estimator refuses next, for the same reason
  if (estimate->forward.determined) {
    limits.forward = estimate->forward.estimate;
  } else {
    refusals.push_back(UndeterminedLimit("forward", estimate->forward, limits.forward));
  }
  if (estimate->reverse.determined) {
    limits.reverse = estimate->reverse.estimate;
  } else {
    refusals.push_back(UndeterminedLimit("reverse", estimate->reverse, limits.reverse));
  }
  return limits;
}

WindowSummary Summarise(const PreparedDataset& dataset) {
  return {dataset.StartTime(),     dataset.EndTime(),     dataset.rows.size(),
          dataset.segments.size(), dataset.slices.size(), dataset.rejected};
}

Result<BoundedEstimates> BoundWithEstimator(const std::optional<Estimator>& estimator,
                                            const PreparedDataset& dataset,
                                            const RegressionOptions& regression,
                                            const IdentifyOptions& options,
                                            const Progress& progress) {
  if (!estimator) return BoundWithSelectedEstimator(dataset, regression, options, progress);
  switch (*estimator) {
    case Estimator::kOneStep: return BoundOneStep(dataset, regression, options, progress);
    case Estimator::kOutputError: return BoundOutputError(dataset, regression, options, progress);
    case Estimator::kWeakIv:
    case Estimator::kPredictionError:  // has a structure of its own
    case Estimator::kUnknown: break;
  }
  return BoundWeakIv(dataset, regression, options, progress);
}

void Describe(const PreparedDataset& dataset, const IdentifyOptions& options,
              Identification& identification) {
  identification.window = Summarise(dataset);
  identification.provenance.preset = Name(options.prepare.preset);
  identification.provenance.seed = options.seed;
  identification.provenance.software_version = Version();
}

Result<Identification> IdentifyPhysically(const Recording& recording, const Vehicle& vehicle,
                                          const IdentifyOptions& options,
                                          const Progress& progress) {
  if (progress) progress("preparing data", 0.0);
  const auto dataset = Prepare(recording, vehicle, options.prepare);
  if (!dataset) return tl::unexpected(dataset.error());
  auto identification = IdentifyPhysicalModel(*dataset, vehicle, options, progress);
  if (identification) Describe(*dataset, options, *identification);
  return identification;
}

/// One-step least squares takes the clocks for one.
Result<AlignedDataset> PrepareFor(const IdentifyOptions& options, const Recording& recording,
                                  const Vehicle& vehicle) {
  if (options.estimator != Estimator::kOneStep)
    return PrepareWithClocksAligned(recording, vehicle, options);
  auto dataset = Prepare(recording, vehicle, options.prepare, Readings::kLeftOut);
  if (!dataset) return tl::unexpected(dataset.error());
  return AlignedDataset{*std::move(dataset), {}, {}};
}

/// Only the weak form's bounds carry what is not known of the delays.
IdentifyOptions WithEstimatorFor(const AlignedDataset& aligned, IdentifyOptions options) {
  if (!options.estimator && aligned.removed.Any()) options.estimator = Estimator::kWeakIv;
  return options;
}

void ReportDelays(const AlignedDataset& aligned, const IdentifyOptions& options,
                  Identification& identification) {
  if (!aligned.removed.Any()) return;
  identification.refusals.push_back(
      WarnOfDelays(aligned, identification.estimator == Estimator::kWeakIv));
  if (!options.estimator) {
    identification.provenance.estimator_choice =
        "weak-form instrumental variables, since the clocks disagree and only its bounds carry "
        "what is not known of the delays";
  }
}

}  // namespace

Result<Identification> Identify(const Recording& recording, const Vehicle& vehicle,
                                const IdentifyOptions& options, const Progress& progress) {
  if (auto refusal = options.Validate()) return tl::unexpected(*refusal);
  if (options.regression.structure == Structure::kFossen) {
    return IdentifyPhysically(recording, vehicle, options, progress);
  }
  // The identification takes as long as one replicate of the coverage check.
  const double share = 1.0 / (1.0 + static_cast<double>(options.coverage_check_replicates));
  if (progress) progress("preparing data", 0.0);
  const auto aligned = PrepareFor(options, recording, vehicle);
  if (!aligned) return tl::unexpected(aligned.error());
  auto identification =
      Identify(aligned->dataset, vehicle.vehicle_id, WithEstimatorFor(*aligned, options),
               ProgressWithin(progress, 0.0, share));
  if (!identification) return identification;
  ReportDelays(*aligned, options, *identification);
  if (options.coverage_check_replicates == 0) return identification;
  auto coverage_check =
      CheckCoverage(WithoutDelays(recording, aligned->removed), vehicle, *identification, options,
                    ProgressWithin(progress, share, 1.0));
  if (coverage_check) {
    identification->coverage_check = *std::move(coverage_check);
  } else {
    identification->refusals.push_back(coverage_check.error());
  }
  return identification;
}

Result<Identification> Identify(const PreparedDataset& dataset, const std::string& vehicle_id,
                                const IdentifyOptions& options, const Progress& progress) {
  if (auto refusal = options.Validate()) return tl::unexpected(*refusal);
  if (options.regression.structure == Structure::kFossen) {
    return Refuse("structure", "FOSSEN is identified from a recording and its vehicle file",
                  "identify from logs, or choose STATIC_QUADRATIC or FIRST_ORDER_DYNAMIC");
  }
  const auto report = [&](std::string_view stage, double fraction) {
    if (progress) progress(stage, fraction);
  };
  const bool identify_dead_zone = options.dead_zone_source == DeadZoneSource::kIdentified;
  RegressionOptions regression = options.regression;
  std::vector<Refusal> dead_zone_refusals;
  if (identify_dead_zone) {
    report("identifying the dead zone", 0.1);
    regression.dead_zone = IdentifyDeadZone(dataset, options, dead_zone_refusals);
  }
  report("estimating", 0.3);
  auto bounded = BoundWithEstimator(options.estimator, dataset, regression, options, progress);
  if (!bounded) return tl::unexpected(bounded.error());

  Identification identification;
  identification.vehicle_id = vehicle_id;
  identification.structure = options.regression.structure;
  identification.parameterization = options.regression.parameterization;
  identification.estimator = bounded->estimator;
  identification.sampling_period_s = dataset.sampling_period_s;
  identification.dead_zone = regression.dead_zone;
  WriteCoefficients(bounded->equation_estimates, bounded->bounds, identification);
  identification.disturbance = bounded->disturbance;
  identification.recording_bias = std::move(bounded->recording_bias);
  identification.refusals = std::move(bounded->equation_estimates.refusals);
  identification.refusals.insert(identification.refusals.end(), dead_zone_refusals.begin(),
                                 dead_zone_refusals.end());
  identification.provenance = std::move(bounded->provenance);
  identification.excitation =
      Summarise(bounded->equation_estimates, options.regression.parameterization);
  FindSimulationParameters(dataset, identification);
  if (options.advise) {
    AdviseManoeuvres({bounded->equation_estimates.excitations, regression, FastestOf(dataset)},
                     identification);
  }
  if (identify_dead_zone) {
    identification.provenance.bounds_basis +=
        "; identified limits of the dead zone are taken as known";
  }
  Describe(dataset, options, identification);
  report("done", 1.0);
  return identification;
}

Result<VesselModel> EstimateModel(const PreparedDataset& dataset,
                                  const RegressionOptions& regression,
                                  const ExcitationLimits& limits) {
  const EquationEstimates equation_estimates =
      EstimateOneStepEquations(dataset, regression, limits);
  for (const Equation equation : kEquations) {
    if (equation_estimates.estimates[IndexOf(equation)]) continue;
    return Refuse(std::string(Name(equation)), "the data cannot answer this equation",
                  equation_estimates.refusals.front().advice);
  }
  return ModelOf(equation_estimates, regression, Discretisation::kForwardEuler,
                 dataset.sampling_period_s);
}

}  // namespace telltale
