#include "telltale/core/identification/weak_iv_estimate.hpp"

#include <algorithm>
#include <sstream>

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

std::string InWords(const BootstrapCorrection& corrected, Eigen::Index clusters) {
  std::ostringstream words;
  words.precision(3);
  words << "clusters of residuals (" << clusters << "), bias corrected and bounds calibrated by "
        << corrected.solved << " parametric bootstrap replicates, Student t";
  return words.str();
}

}  // namespace

Result<PreparedDataset> PrepareForWeakIv(const Recording& recording, const Vehicle& vehicle,
                                         const PrepareOptions& options) {
  PrepareOptions chosen = options;
  const auto preview = Prepare(recording, vehicle, chosen);
  if (!preview) return tl::unexpected(preview.error());
  chosen.smoothing_half_width = SmoothingFor(*preview);
  chosen.longest_segment_s = kLongestPartS;
  return Prepare(recording, vehicle, chosen);
}

PreliminaryWeakFit FitPreliminaryWeakForm(const PreparedDataset& dataset,
                                          const RegressionOptions& regression,
                                          const IdentifyOptions& options) {
  PreliminaryWeakFit preliminary{
      AssessExcitation(dataset, regression, options.excitation), {}, std::nullopt};
  preliminary.columns = ExcitedColumns(preliminary.equation_estimates);
  if (preliminary.equation_estimates.Any()) {
    preliminary.fit = EstimateWeakIv(dataset, regression, preliminary.columns, options.weak_iv);
  }
  return preliminary;
}

Result<BoundedEstimates> BoundWeakIv(const PreparedDataset& dataset,
                                     const RegressionOptions& regression,
                                     const IdentifyOptions& options, const Progress& progress,
                                     const std::optional<PreliminaryWeakFit>& preliminary) {
  BoundedEstimates bounded;
  bounded.estimator = Estimator::kWeakIv;
  EquationEstimates& equation_estimates = bounded.equation_estimates;
  equation_estimates = preliminary ? preliminary->equation_estimates
                                   : AssessExcitation(dataset, regression, options.excitation);
  if (!equation_estimates.Any())
    return tl::unexpected(RefuseAllEquations(equation_estimates.refusals));
  const SeparableColumns separable =
      Separate(dataset, regression, ExcitedColumns(equation_estimates), options.weak_iv.form);
  ReportCollinearGroups(separable, regression.parameterization, equation_estimates);
  const auto columns = WithRecordingBiases(dataset, regression, separable.kept,
                                           options.weak_iv.form, equation_estimates.refusals);
  const auto fit = preliminary && preliminary->columns == columns
                       ? preliminary->fit
                       : EstimateWeakIv(dataset, regression, columns, options.weak_iv);
  if (!fit || fit->scores.cols() < 2 || !ClusterCovariance(*fit).allFinite()) {
    return tl::unexpected(RefuseWeakInstruments());
  }
  CountTestFunctions(*fit, equation_estimates);
  const Eigen::Index clusters = fit->scores.cols();
  bounded.provenance.clusters = static_cast<std::size_t>(clusters);
  if (auto warning = WarnOfFewClusters(clusters))
    equation_estimates.refusals.push_back(*std::move(warning));

  std::optional<BootstrapCorrection> corrected;
  if (options.parametric_replicates > 0) {
    corrected = CorrectByParametricBootstrap(
        dataset, regression, *fit, columns, options.weak_iv,
        {options.parametric_replicates, options.seed, options.threads}, [&](double fraction) {
          if (progress) progress("simulating replicates", 0.4 + 0.55 * fraction);
        });
    if (!corrected) equation_estimates.refusals.push_back(WarnOfUncorrectedBias());
  }
  const ReportedParameters reported_parameters = ReportedParametersOf(*fit);
  const auto write_bounds = [&](const Eigen::VectorXd& theta, const Eigen::MatrixXd& covariance,
                                const Eigen::VectorXd& interval_factors,
                                double degrees_of_freedom) {
    const Eigen::VectorXd reported = reported_parameters.map * theta;
    Unstack(*fit, reported_parameters, reported, equation_estimates);
    bounded.bounds = StudentBounds(reported, Mapped(reported_parameters.map, covariance),
                                   ReportedIntervalFactors(reported_parameters, interval_factors),
                                   degrees_of_freedom, options.interval_level);
    RemoveBounds(separable, equation_estimates, bounded.bounds);
    bounded.recording_bias =
        RecordingBiasesOf(reported_parameters, reported, bounded.bounds, dataset);
  };
  if (corrected) {
    write_bounds(corrected->theta, corrected->covariance, corrected->interval_factors,
                 corrected->degrees_of_freedom);
    bounded.bounds.joint = corrected->joint;
    bounded.disturbance = corrected->disturbance;
    bounded.provenance.parametric_replicates = corrected->solved;
    bounded.provenance.parametric_replicate_failures = corrected->failures;
    bounded.provenance.bounds_basis = InWords(*corrected, clusters);
    return bounded;
  }
  write_bounds(fit->theta, ClusterCovariance(*fit), Eigen::VectorXd::Ones(fit->theta.size()),
               static_cast<double>(clusters - 1));
  bounded.provenance.bounds_basis =
      "clusters of residuals (" + std::to_string(clusters) + "), Student t; not corrected for bias";
  return bounded;
}

}  // namespace telltale
