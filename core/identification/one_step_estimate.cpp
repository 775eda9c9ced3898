#include "telltale/core/identification/one_step_estimate.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>
#include <utility>

#include "telltale/core/estimation/regression/lagged_regression.hpp"
#include "telltale/core/estimation/regression/one_step.hpp"
#include "telltale/core/uncertainty/bootstrap.hpp"
#include "telltale/core/uncertainty/bootstrap_correction.hpp"
#include "telltale/core/uncertainty/clustered_fit.hpp"
#include "telltale/core/uncertainty/parametric_bootstrap.hpp"
#include "telltale/core/uncertainty/profile_interval.hpp"

namespace telltale {
namespace {

// A bootstrap over fewer independent slices or blocks than this is not reliable.
constexpr std::size_t kFewestUnits = 8;

/// EquationEstimates and what they were fitted to: equations of the static structure, or all three
/// lagged.
struct Fitted {
  EquationEstimates equation_estimates;
  std::optional<LaggedProblem> lagging;
  std::array<EquationProblem, 3> equations;
  std::optional<LaggedEstimate> lagged;
};

void SetFirstUnknowns(Eigen::Index next, EquationEstimates& equation_estimates) {
  for (std::size_t j = 0; j < equation_estimates.estimates.size(); ++j) {
    if (!equation_estimates.estimates[j]) continue;
    equation_estimates.first[j] = next;
    next += equation_estimates.estimates[j]->theta.size();
  }
}

Fitted FitStatic(const PreparedDataset& dataset, const RegressionOptions& regression,
                 const ExcitationLimits& limits) {
  Fitted fitted;
  fitted.equations = BuildRegression(dataset, regression).equations;
  EquationEstimates& equation_estimates = fitted.equation_estimates;
  AssessEquations(fitted.equations, limits, equation_estimates);
  for (std::size_t j = 0; j < fitted.equations.size(); ++j) {
    if (equation_estimates.excitations[j])
      equation_estimates.estimates[j] = EstimateOneStep(*equation_estimates.excitations[j]);
  }
  SetFirstUnknowns(0, equation_estimates);
  return fitted;
}

Fitted FitDynamic(const PreparedDataset& dataset, const RegressionOptions& regression,
                  const ExcitationLimits& limits) {
  Fitted fitted;
  fitted.lagging = BuildLagged(dataset, regression);
  const LaggedProblem& problem = *fitted.lagging;
  EquationEstimates& equation_estimates = fitted.equation_estimates;
  AssessEquations(problem.at_once.equations, limits, equation_estimates);
  if (!equation_estimates.Any()) return fitted;
  fitted.lagged = EstimateLagged(problem, equation_estimates.excitations);
  equation_estimates.lag =
      LagEstimate{fitted.lagged->time_constant_s, fitted.lagged->lag_at_lower_bound};
  equation_estimates.estimates = fitted.lagged->equations;
  SetFirstUnknowns(1, equation_estimates);  // the time constant comes first
  return fitted;
}

Fitted Fit(const PreparedDataset& dataset, const RegressionOptions& regression,
           const ExcitationLimits& limits) {
  return regression.structure == Structure::kFirstOrderDynamic
             ? FitDynamic(dataset, regression, limits)
             : FitStatic(dataset, regression, limits);
}

/// What bounds are made from. Takes the equations out of `fitted`: rows of them and of their fits
/// would fill as much memory as all else.
std::vector<ClusteredFit> FitsOf(Fitted& fitted, Replicates replicates) {
  if (fitted.lagged) return {FitOf(*fitted.lagged)};
  std::vector<ClusteredFit> fits;
  for (std::size_t j = 0; j < fitted.equations.size(); ++j) {
    const auto& estimate = fitted.equation_estimates.estimates[j];
    EquationProblem equation = std::exchange(fitted.equations[j], {});
    if (estimate) fits.push_back(FitOf(std::move(equation), *estimate, replicates));
  }
  return fits;
}

Bounds BoundsFor(const std::vector<ClusteredFit>& fits) {
  Bounds bounds;
  Eigen::Index size = 0;
  for (const ClusteredFit& fit : fits) {
    size += fit.theta.size();
    bounds.estimable.insert(bounds.estimable.end(), fit.estimable.begin(), fit.estimable.end());
  }
  bounds.covariance = Eigen::MatrixXd::Zero(size, size);
  bounds.degrees_of_freedom = fits.front().degrees_of_freedom;
  return bounds;
}

Bounds ResidualBounds(const std::vector<ClusteredFit>& fits, double level) {
  Bounds bounds = BoundsFor(fits);
  Eigen::Index first = 0;
  for (const ClusteredFit& fit : fits) {
    const Eigen::Index p = fit.theta.size();
    auto block = bounds.covariance.block(first, first, p, p);
    block = ResidualCovariance(fit);
    for (Eigen::Index j = 0; j < p; ++j) {
      bounds.intervals.push_back(
          StudentInterval(fit.theta[j], std::sqrt(block(j, j)), fit.degrees_of_freedom, level));
    }
    first += p;
  }
  return bounds;
}

Bounds ReplicateBounds(const std::vector<ClusteredFit>& fits, const BootstrapReplicates& replicates,
                       IntervalMethod method, double level) {
  Bounds bounds = BoundsFor(fits);
  bounds.covariance = Covariance(replicates);
  bounds.intervals = Intervals(replicates, method, level);
  return bounds;
}

/// The estimate of all stacked unknowns, its errors by white residuals.
Refit RefitOf(const std::vector<ClusteredFit>& fits) {
  Eigen::Index size = 0;
  for (const ClusteredFit& fit : fits) size += fit.theta.size();
  Refit refit{Eigen::VectorXd(size), Eigen::VectorXd(size)};
  Eigen::Index first = 0;
  for (const ClusteredFit& fit : fits) {
    refit.theta.segment(first, fit.theta.size()) = fit.theta;
    refit.standard_error.segment(first, fit.theta.size()) =
        ResidualCovariance(fit).diagonal().cwiseSqrt();
    first += fit.theta.size();
  }
  return refit;
}

bool SameColumns(const EquationEstimates& first, const EquationEstimates& second) {
  for (std::size_t j = 0; j < first.estimates.size(); ++j) {
    const auto& a = first.estimates[j];
    const auto& b = second.estimates[j];
    if (a.has_value() != b.has_value() || (a && a->columns != b->columns)) return false;
  }
  return true;
}

/// The disturbance by the residuals of the weak form, which noisy velocities do not inflate.
Disturbance DisturbanceOf(const Fitted& fitted, const PreparedDataset& dataset,
                          const RegressionOptions& regression, const IdentifyOptions& options) {
  std::array<std::vector<std::size_t>, 3> columns;
  for (std::size_t j = 0; j < columns.size(); ++j) {
    if (fitted.equation_estimates.estimates[j])
      columns[j] = fitted.equation_estimates.estimates[j]->columns;
  }
  const auto weak = EstimateWeakIv(dataset, regression, columns, options.weak_iv);
  if (!weak) return {};
  return DisturbanceFromResiduals(dataset, regression, *weak, options.weak_iv, options.seed)
      .value_or(Disturbance());
}

BootstrapReplicates SimulatedReplicates(const Fitted& fitted, const std::vector<ClusteredFit>& fits,
                                        const PreparedDataset& dataset,
                                        const RegressionOptions& regression,
                                        const IdentifyOptions& options, BoundedEstimates& bounded) {
  const VesselModel boat = ModelOf(fitted.equation_estimates, regression,
                                   Discretisation::kContinuous, dataset.sampling_period_s);
  bounded.disturbance = DisturbanceOf(fitted, dataset, regression, options);
  const auto refit = [&](const PreparedDataset& replicate) -> std::optional<Refit> {
    Fitted refitted = Fit(replicate, regression, options.excitation);
    if (!SameColumns(fitted.equation_estimates, refitted.equation_estimates)) return std::nullopt;
    return RefitOf(FitsOf(refitted, Replicates::kNone));
  };
  return SimulateReplicates(dataset, boat, *bounded.disturbance, RefitOf(fits), refit,
                            {options.bootstrap_replicates, options.seed, options.threads});
}

/// The equations of the dynamic structure are fitted as one, so their residuals share one
/// autocorrelation.
void CountRows(const std::vector<ClusteredFit>& fits, Fitted& fitted) {
  std::size_t next = 0;
  for (std::size_t j = 0; j < fitted.equation_estimates.estimates.size(); ++j) {
    if (!fitted.equation_estimates.estimates[j]) continue;
    const ClusteredFit& fit = fits[fitted.lagged ? 0 : next++];
    SampleSize& size = fitted.equation_estimates.sizes[j];
    size = SizeOf(fit.residual, fit.instants, 1);
    if (!fitted.lagged) continue;
    const double share =
        static_cast<double>(fitted.equation_estimates.excitations[j]->factor.rows) /
        static_cast<double>(size.rows);
    size.rows = static_cast<std::size_t>(fitted.equation_estimates.excitations[j]->factor.rows);
    size.effective_rows *= share;
  }
}

std::size_t SlicesWithRows(const ClusteredFit& fit) {
  return static_cast<std::size_t>(std::count_if(fit.clusters.begin(), fit.clusters.end(),
                                                [](const RowRange& c) { return c.size() > 0; }));
}

std::optional<Refusal> WarnOfFewUnits(const std::vector<ClusteredFit>& fits,
                                      const BootstrapReplicates& replicates) {
  const bool blocks = replicates.block_length > 0;
  std::size_t fewest = replicates.draws;
  if (!blocks) {
    for (const ClusteredFit& fit : fits) fewest = std::min(fewest, SlicesWithRows(fit));
  }
  if (fewest >= kFewestUnits) return std::nullopt;
  return Refusal{"bounds",
                 "rest on only " + std::to_string(fewest) + " independent " +
                     (blocks ? "blocks, " : "slices, ") + std::to_string(kFewestUnits) +
                     " are needed to trust them",
                 "record for longer, with more changes of manoeuvre"};
}

std::string InWords(const BootstrapReplicates& replicates, double sampling_period_s) {
  if (replicates.block_length == 0) return "slice bootstrap";
  std::ostringstream words;
  words << "moving-block bootstrap, blocks of " << replicates.block_length << " rows ("
        << static_cast<double>(replicates.block_length) * sampling_period_s << " s)";
  return words.str();
}

std::string InWords(IntervalMethod method) {
  switch (method) {
    case IntervalMethod::kStudentized: return "studentized intervals";
    case IntervalMethod::kBca: return "bias-corrected and accelerated (BCa) intervals";
    case IntervalMethod::kPercentile:
    case IntervalMethod::kUnknown: break;
  }
  return "percentile intervals";
}

std::optional<Refusal> WarnOfFailures(const BootstrapReplicates& replicates) {
  const auto solved = static_cast<std::size_t>(replicates.theta.cols());
  // A 95 % interval keeps its level when one in twenty draws is lost at random.
  if (replicates.failures * 20 <= solved) return std::nullopt;
  return Refusal{"bounds",
                 std::to_string(replicates.failures) + " of " +
                     std::to_string(replicates.failures + solved) +
                     " bootstrap draws could not be solved: some coefficient depends on few "
                     "slices",
                 "repeat the manoeuvres that occur only once or twice"};
}

/// Replaces the interval of the time constant by that of its profile likelihood where the two sides
/// of it differ badly, and says so.
void ProfileTimeConstant(const ClusteredFit& fit, double level, Fitted& fitted,
                         BoundedEstimates& bounded) {
  constexpr double kStronglyAsymmetric = 1.25;
  const double white = ResidualCovariance(fit)(0, 0);
  const double variance = bounded.bounds.covariance(0, 0);
  if (!(white > 0.0) || !std::isfinite(variance)) return;
  // Coloured residuals make a likelihood that takes them for white as much too sharp.
  const double sharpness = std::max(1.0, variance / white);
  const double quantile = StudentInterval(0.0, 1.0, fit.degrees_of_freedom, level).upper;
  const LagLimits limits = LimitsOfLag(*fitted.lagging);
  const double estimate = fitted.lagged->time_constant_s;
  const Interval profile = ProfileInterval(
      [&](double tau) {
        return LagDeviance(*fitted.lagging, fitted.equation_estimates.excitations, *fitted.lagged,
                           tau);
      },
      {estimate, std::sqrt(variance), limits.shortest_s, limits.longest_s},
      sharpness * quantile * quantile, level);
  if (Asymmetry(profile, estimate) < kStronglyAsymmetric) return;
  fitted.equation_estimates.lag->profile = profile;
  bounded.provenance.bounds_basis += "; the time constant's by profile likelihood, asymmetric";
}

}  // namespace

EquationEstimates EstimateOneStepEquations(const PreparedDataset& dataset,
                                           const RegressionOptions& regression,
                                           const ExcitationLimits& limits) {
  return Fit(dataset, regression, limits).equation_estimates;
}

Result<BoundedEstimates> BoundOneStep(const PreparedDataset& dataset,
                                      const RegressionOptions& regression,
                                      const IdentifyOptions& options, const Progress& progress) {
  Fitted fitted = Fit(dataset, regression, options.excitation);
  if (!fitted.equation_estimates.Any())
    return tl::unexpected(RefuseAllEquations(fitted.equation_estimates.refusals));
  const std::vector<ClusteredFit> fits =
      FitsOf(fitted, options.bootstrap_replicates > 0 ? Replicates::kDrawn : Replicates::kNone);
  CountRows(fits, fitted);
  BoundedEstimates bounded;
  bounded.estimator = Estimator::kOneStep;
  bounded.provenance.bootstrap_replicates = options.bootstrap_replicates;
  if (options.bootstrap_replicates == 0) {
    bounded.bounds = ResidualBounds(fits, options.interval_level);
    bounded.provenance.bounds_basis =
        "residual covariance, white residuals assumed; too narrow where residuals are coloured or "
        "velocities noisy";
    if (fitted.lagged) ProfileTimeConstant(fits.front(), options.interval_level, fitted, bounded);
    bounded.equation_estimates = std::move(fitted.equation_estimates);
    return bounded;
  }
  if (progress) progress("bootstrapping", 0.5);
  const bool parametric = options.resampling == Resampling::kParametric;
  const BootstrapReplicates replicates =
      parametric ? SimulatedReplicates(fitted, fits, dataset, regression, options, bounded)
                 : Bootstrap(fits, {options.bootstrap_replicates, options.seed, options.threads,
                                    options.resampling, options.interval_method});
  if (replicates.theta.cols() < 2) {
    return Refuse("bounds", "no bootstrap replicate could be solved",
                  "record for longer, or ask for bounds from residuals with 0 replicates");
  }
  auto& refusals = fitted.equation_estimates.refusals;
  if (auto warning = WarnOfFewUnits(fits, replicates)) refusals.push_back(*warning);
  if (auto warning = WarnOfFailures(replicates)) refusals.push_back(*warning);
  bounded.provenance.bootstrap_failures = replicates.failures;
  bounded.provenance.bounds_basis =
      (parametric ? "parametric bootstrap, synthetic datasets"
                  : InWords(replicates, dataset.sampling_period_s)) +
      ", " + InWords(options.interval_method) +
      (parametric && options.interval_method == IntervalMethod::kStudentized
           ? "; attenuation of one-step least squares by noisy velocities is taken out to first "
             "order"
           : "; attenuation of one-step least squares by noisy velocities is not covered");
  bounded.bounds =
      ReplicateBounds(fits, replicates, options.interval_method, options.interval_level);
  if (fitted.lagged) ProfileTimeConstant(fits.front(), options.interval_level, fitted, bounded);
  bounded.equation_estimates = std::move(fitted.equation_estimates);
  return bounded;
}

}  // namespace telltale
