#include "telltale/core/identification/weak_iv_estimate.hpp"

#include <algorithm>
#include <sstream>
#include <utility>

#include "telltale/core/base/linear_algebra/covariance.hpp"
#include "telltale/core/data/preparation.hpp"
#include "telltale/core/estimation/weak_form/separable_columns.hpp"
#include "telltale/core/estimation/weak_form/weak_iv.hpp"
#include "telltale/core/identification/weak_iv_reported_parameters.hpp"
#include "telltale/core/uncertainty/bootstrap_correction.hpp"

namespace telltale {
namespace {

constexpr double kLongestPartS = 60.0;

Refusal WarnOfConstantHeading(std::size_t recordings) {
  return {"constant disturbance",
          "in " + std::to_string(recordings) +
              " of the recordings the heading hardly varies: a part that stands to the north and "
              "east is collinear with one that turns with the boat, and is left out there",
          "record courses in all directions"};
}

/// The columns that are sought, steady terms of each recording among them.
std::array<std::vector<std::size_t>, 3> WithRecordingBiases(
    const PreparedDataset& dataset, const RegressionOptions& regression,
    const std::array<std::vector<std::size_t>, 3>& columns, const WeakFormOptions& form,
    std::vector<Refusal>& refusals) {
  if (regression.recording_bias == RecordingBiasModel::kShared) return columns;
  const std::vector<bool> varies = HeadingVaries(dataset);
  const auto steady = std::count(varies.begin(), varies.end(), false);
  if (regression.recording_bias == RecordingBiasModel::kPerRecordingNorthEast && steady > 0) {
    refusals.push_back(WarnOfConstantHeading(static_cast<std::size_t>(steady)));
  }
  return WithRecordingBiasTerms(dataset, BuildWeakForm(dataset, regression, form), columns, varies);
}

bool Names(const std::vector<Refusal>& refusals, const Refusal& named) {
  return std::any_of(refusals.begin(), refusals.end(),
                     [&](const Refusal& refusal) { return refusal.subject == named.subject; });
}

/// Reports the groups of collinear columns that are separated before estimation.
void ReportCollinearGroups(const SeparableColumns& separable, Parameterization parameterization,
                           EquationEstimates& equation_estimates) {
  for (const Equation equation : kEquations) {
    EquationProblem names;
    names.equation = equation;
    names.regressors = Regressors(equation, parameterization);
    for (const CollinearGroup& group : separable.groups[IndexOf(equation)]) {
      const Refusal refusal = Explain(group, names);
      equation_estimates.excitations[IndexOf(equation)]->collinear.push_back(group);
      if (!Names(equation_estimates.refusals, refusal))
        equation_estimates.refusals.push_back(refusal);
    }
  }
}

/// No coefficient of a dependency that was cut has bounds.
void RemoveBounds(const SeparableColumns& separable, const EquationEstimates& equation_estimates,
                  Bounds& bounds) {
  for (std::size_t j = 0; j < separable.groups.size(); ++j) {
    for (const CollinearGroup& group : separable.groups[j]) {
      for (const std::size_t column : group.columns) {
        const auto& excited_columns = equation_estimates.estimates[j]->columns;
        const auto found = std::find(excited_columns.begin(), excited_columns.end(), column);
        if (found == excited_columns.end()) continue;
        const auto place = static_cast<std::size_t>(equation_estimates.first[j] +
                                                    (found - excited_columns.begin()));
        bounds.estimable[place] = false;
      }
    }
  }
}

/// Splits the reported parameters into the estimates of the equations.
void Unstack(const WeakFit& fit, const ReportedParameters& reported_parameters,
             const Eigen::VectorXd& theta, EquationEstimates& equation_estimates) {
  Eigen::Index next = 0;
  if (fit.time_constant_s) {
    equation_estimates.lag = LagEstimate{std::max(theta[next++], 0.0), LagIsAtLowerBound(fit)};
  }
  for (std::size_t j = 0; j < fit.equations.size(); ++j) {
    if (!fit.equations[j]) continue;
    const std::vector<std::size_t>& columns = reported_parameters.columns[j];
    const auto size = static_cast<Eigen::Index>(columns.size());
    PlaceEstimate(kEquations[j], columns, theta.segment(next, size), next, equation_estimates);
    next += size;
  }
}

void CountTestFunctions(const WeakFit& fit, EquationEstimates& equation_estimates) {
  for (std::size_t j = 0; j < fit.equations.size(); ++j) {
    if (!fit.equations[j]) continue;
    equation_estimates.sizes[j] = SizeOf(
        fit.equations[j]->residual, fit.problem.supports[j].first_rows, fit.problem.phi.stride);
  }
}

/// Unknown delays take up part of what filtering does to a fit. Replicates correct for that; where
/// there are none the clocks are taken for one.
WeakIvOptions FitOptionsOf(const IdentifyOptions& options) {
  WeakIvOptions of_fit = options.weak_iv;
  of_fit.delays = of_fit.delays && options.parametric_replicates > 0;
  return of_fit;
}

Refusal WarnOfUncorrectedBias() {
  return {"bounds",
          "fewer than half of the parametric bootstrap replicates could be identified, so "
          "the bias is neither known nor corrected",
          "record for longer, with more varied manoeuvres"};
}

Refusal RefuseWeakInstruments() {
  return {
      "model",
      "velocities simulated with the model are not correlated with those measured, so they cannot "
      "serve as instruments",
      "record more varied manoeuvres for longer, or ask for the one-step estimator"};
}

/// A mean of several unknowns has an interval as long as the one that takes the longest.
Eigen::VectorXd ReportedIntervalFactors(const ReportedParameters& reported_parameters,
                                        const Eigen::VectorXd& interval_factors) {
  Eigen::VectorXd factors(reported_parameters.map.rows());
  for (Eigen::Index i = 0; i < factors.size(); ++i) {
    const auto takes_part = reported_parameters.map.row(i).array() != 0.0;
    factors[i] = takes_part.select(interval_factors.transpose().array(), 0.0).maxCoeff();
  }
  return factors;
}

std::string InWords(const BootstrapCorrection& corrected, const WeakFit& fit) {
  std::ostringstream words;
  words.precision(3);
  words << "clusters of residuals (" << fit.scores.cols()
        << "), bias corrected and bounds calibrated by " << corrected.solved
        << " parametric bootstrap replicates, Student t";
  if (fit.delays) words << "; delays between the channels are among the unknowns";
  return words.str();
}

/// The columns that are estimated once collinear ones are cut.
struct Estimable {
  SeparableColumns separable;
  std::array<std::vector<std::size_t>, 3> columns;  ///< steady terms of each recording among them
};

Estimable EstimableColumns(const PreparedDataset& dataset, const RegressionOptions& regression,
                           const WeakFormOptions& form, EquationEstimates& equation_estimates) {
  Estimable estimable{Separate(dataset, regression, ExcitedColumns(equation_estimates), form), {}};
  ReportCollinearGroups(estimable.separable, regression.parameterization, equation_estimates);
  estimable.columns = WithRecordingBiases(dataset, regression, estimable.separable.kept, form,
                                          equation_estimates.refusals);
  return estimable;
}

/// The preliminary fit where it is of the same columns, else another in its place.
std::optional<WeakFit> FitOf(const std::array<std::vector<std::size_t>, 3>& columns,
                             std::optional<PreliminaryWeakFit> preliminary,
                             const PreparedDataset& dataset, const RegressionOptions& regression,
                             const IdentifyOptions& options) {
  if (preliminary && preliminary->columns == columns) return std::move(preliminary->fit);
  preliminary.reset();  // either fills as much memory as the data
  return EstimateWeakIv(dataset, regression, columns, FitOptionsOf(options));
}

/// Estimates with their covariance, and how far beyond a standard error each bound lies.
struct Bounding {
  Eigen::VectorXd theta;
  Eigen::MatrixXd covariance;
  Eigen::VectorXd interval_factors;
  double degrees_of_freedom = 0.0;
};

/// Without replicates: clusters of residuals alone.
Bounding ByClusters(const WeakFit& fit) {
  return {fit.theta, ClusterCovariance(fit), Eigen::VectorXd::Ones(fit.theta.size()),
          static_cast<double>(fit.scores.cols() - 1)};
}

void WriteBounds(const Bounding& bounding, const WeakFit& fit, const PreparedDataset& dataset,
                 const SeparableColumns& separable, double level, BoundedEstimates& bounded) {
  const ReportedParameters parameters = ReportedParametersOf(fit);
  const Eigen::VectorXd reported = parameters.map * bounding.theta;
  Unstack(fit, parameters, reported, bounded.equation_estimates);
  bounded.bounds = StudentBounds(reported, Mapped(parameters.map, bounding.covariance),
                                 ReportedIntervalFactors(parameters, bounding.interval_factors),
                                 bounding.degrees_of_freedom, level);
  RemoveBounds(separable, bounded.equation_estimates, bounded.bounds);
  bounded.recording_bias = RecordingBiasesOf(parameters, reported, bounded.bounds, dataset);
}

void WriteProvenance(const BootstrapCorrection& corrected, const WeakFit& fit,
                     BoundedEstimates& bounded) {
  bounded.bounds.joint = corrected.joint;
  bounded.disturbance = corrected.disturbance;
  bounded.provenance.parametric_replicates = corrected.solved;
  bounded.provenance.parametric_replicate_failures = corrected.failures;
  bounded.provenance.bounds_basis = InWords(corrected, fit);
}

}  // namespace

Result<PreparedDataset> PrepareForWeakIv(const Recording& recording, const Vehicle& vehicle,
                                         const PrepareOptions& options, Readings readings) {
  PrepareOptions chosen = options;
  {
    const auto preview = Prepare(recording, vehicle, chosen, Readings::kLeftOut);
    if (!preview) return tl::unexpected(preview.error());
    chosen.smoothing_half_width = SmoothingFor(*preview);
  }  // it would stand in memory beside what follows
  chosen.longest_segment_s = kLongestPartS;
  return Prepare(recording, vehicle, chosen, readings);
}

PreliminaryWeakFit FitPreliminaryWeakForm(const PreparedDataset& dataset,
                                          const RegressionOptions& regression,
                                          const IdentifyOptions& options) {
  PreliminaryWeakFit preliminary{
      AssessExcitation(dataset, regression, options.excitation), {}, std::nullopt};
  preliminary.columns = ExcitedColumns(preliminary.equation_estimates);
  if (preliminary.equation_estimates.Any()) {
    preliminary.fit =
        EstimateWeakIv(dataset, regression, preliminary.columns, FitOptionsOf(options));
  }
  return preliminary;
}

Result<BoundedEstimates> BoundWeakIv(const PreparedDataset& dataset,
                                     const RegressionOptions& regression,
                                     const IdentifyOptions& options, const Progress& progress,
                                     std::optional<PreliminaryWeakFit> preliminary) {
  BoundedEstimates bounded;
  bounded.estimator = Estimator::kWeakIv;
  EquationEstimates& equation_estimates = bounded.equation_estimates;
  equation_estimates = preliminary ? preliminary->equation_estimates
                                   : AssessExcitation(dataset, regression, options.excitation);
  if (!equation_estimates.Any())
    return tl::unexpected(RefuseAllEquations(equation_estimates.refusals));
  const auto [separable, columns] =
      EstimableColumns(dataset, regression, options.weak_iv.form, equation_estimates);
  const auto fit = FitOf(columns, std::move(preliminary), dataset, regression, options);
  if (!fit || fit->scores.cols() < 2 || !ClusterCovariance(*fit).allFinite()) {
    return tl::unexpected(RefuseWeakInstruments());
  }
  CountTestFunctions(*fit, equation_estimates);
  const Eigen::Index clusters = fit->scores.cols();
  bounded.provenance.clusters = static_cast<std::size_t>(clusters);
  if (auto warning = WarnOfFewClusters(clusters))
    equation_estimates.refusals.push_back(*std::move(warning));

  if (options.parametric_replicates > 0) {
    const auto corrected = CorrectByParametricBootstrap(
        dataset, regression, *fit, columns, options.weak_iv,
        {options.parametric_replicates, options.seed, options.threads}, [&](double fraction) {
          if (progress) progress("simulating replicates", 0.4 + 0.55 * fraction);
        });
    if (corrected) {
      WriteBounds({corrected->theta, corrected->covariance, corrected->interval_factors,
                   corrected->degrees_of_freedom},
                  *fit, dataset, separable, options.interval_level, bounded);
      WriteProvenance(*corrected, *fit, bounded);
      return bounded;
    }
    equation_estimates.refusals.push_back(WarnOfUncorrectedBias());
  }
  WriteBounds(ByClusters(*fit), *fit, dataset, separable, options.interval_level, bounded);
  bounded.provenance.bounds_basis =
      "clusters of residuals (" + std::to_string(clusters) +
      "), Student t; not corrected for bias, and the clocks taken for one";
  return bounded;
}

}  // namespace telltale
