#include "telltale/core/identification/output_error_estimate.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "telltale/core/base/contract.hpp"
#include "telltale/core/base/parallel.hpp"
#include "telltale/core/estimation/output_error/output_error_covariance.hpp"
#include "telltale/core/estimation/output_error/output_error_profile.hpp"
#include "telltale/core/estimation/weak_form/weak_iv.hpp"
#include "telltale/core/uncertainty/profile_interval.hpp"

namespace telltale {
namespace {

constexpr double kUnbounded = std::numeric_limits<double>::infinity();

/// Why not, if an equation cannot be answered.
std::optional<Refusal> RefuseMissingEquation(const EquationEstimates& equation_estimates) {
  for (const Equation equation : kEquations) {
    if (equation_estimates.excitations[IndexOf(equation)]) continue;
    const auto why =
        std::find_if(equation_estimates.refusals.begin(), equation_estimates.refusals.end(),
                     [&](const Refusal& refusal) { return refusal.subject == Name(equation); });
    Require(why != equation_estimates.refusals.end(),
            "a refusal of every equation that is not answered");
    return Refusal{"output error",
                   "it simulates all three equations together, and " + why->subject +
                       " has none: " + why->reason,
                   why->advice + ", or ask for weak-iv, which answers them one by one"};
  }
  return std::nullopt;
}

/// Unknowns that something measured moves with: all but those that are a direction by themselves.
std::vector<Eigen::Index> ObservableUnknowns(const OutputErrorFit& fit) {
  std::vector<bool> observable(static_cast<std::size_t>(fit.theta.size()), true);
  for (const InseparableDirection& direction : fit.separability.directions) {
    if (direction.unknowns.size() == 1) observable[direction.unknowns.front()] = false;
  }
  if (fit.unknowns.lagging) observable.front() = true;  // a time constant is always answered
  std::vector<Eigen::Index> places;
  for (std::size_t j = 0; j < observable.size(); ++j) {
    if (observable[j]) places.push_back(static_cast<Eigen::Index>(j));
  }
  return places;
}

/// Bounds of the unknowns at `places`; of the inseparable among them nothing is known.
Bounds BoundsAt(const OutputErrorFit& fit, const std::vector<Eigen::Index>& places, double level) {
  Eigen::MatrixXd covariance = ClusterCovariance(fit)(places, places);
  const auto degrees_of_freedom = static_cast<double>(fit.scores.cols()) - 1.0;
  Bounds bounds = StudentBounds(fit.theta(places), covariance, degrees_of_freedom, level);
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (fit.separability.separable[static_cast<std::size_t>(places[i])]) continue;
    const auto at = static_cast<Eigen::Index>(i);
    bounds.estimable[i] = false;
    bounds.intervals[i] = Unbounded(level);
    bounds.covariance.row(at).setZero();
    bounds.covariance.col(at).setZero();
    bounds.covariance(at, at) = kUnbounded;
  }
  return bounds;
}

/// Hotelling's law: the covariance is one of as many scores as there are clusters. Nothing where
/// those are hardly more than unknowns.
std::optional<JointBounds> JointOf(const Bounds& bounds) {
  constexpr double kFewestSpare = 5.0;
  const auto unknowns =
      static_cast<double>(std::count(bounds.estimable.begin(), bounds.estimable.end(), true));
  const double spare = bounds.degrees_of_freedom - unknowns + 1.0;
  if (unknowns == 0.0 || spare < kFewestSpare) return std::nullopt;
  return JointBounds{bounds.degrees_of_freedom / spare, bounds.degrees_of_freedom};
}

/// How far the profile of an unknown is followed, in half widths of its interval.
constexpr double kProfileHalfWidths = 15.0;

/// The interval of one unknown by its profile if that is strongly asymmetric.
std::optional<Interval> AsymmetricInterval(const OutputErrorProfile& profile,
                                           const OutputErrorFit& fit, Eigen::Index unknown,
                                           double variance, double quantile, double level) {
  constexpr double kPerhapsAsymmetric = 1.15;
  constexpr double kStronglyAsymmetric = 1.25;
  const double half_width = quantile * std::sqrt(variance);
  if (profile.Asymmetry(unknown, half_width) < kPerhapsAsymmetric) return std::nullopt;
  // A likelihood that takes residuals for white is too sharp where clusters show that they are not.
  const double sharpness = std::max(1.0, variance / NaiveCovariance(fit)(unknown, unknown));
  const double estimate = fit.theta[unknown];
  ProfileSearch search{estimate, half_width, estimate - kProfileHalfWidths * half_width,
                       estimate + kProfileHalfWidths * half_width};
  const bool is_lag = fit.unknowns.lagging && unknown == 0;
  if (is_lag) {
    search.lowest = kShortestTimeConstantS;
    search.highest = kLongestTimeConstantS;
  }
  Interval interval =
      ProfileInterval([&](double value) { return profile.Deviance(unknown, value); }, search,
                      sharpness * quantile * quantile, level);
  if (!is_lag && interval.lower <= search.lowest) interval.lower = -kUnbounded;
  if (!is_lag && interval.upper >= search.highest) interval.upper = kUnbounded;
  if (Asymmetry(interval, estimate) < kStronglyAsymmetric) return std::nullopt;
  return interval;
}

/// Replaces strongly asymmetric intervals by those of the profile likelihood, and writes their
/// number into the provenance.
void ProfileAsymmetric(const OutputErrorProfile& profile, const OutputErrorFit& fit,
                       const std::vector<Eigen::Index>& places, const IdentifyOptions& options,
                       BoundedEstimates& bounded) {
  Bounds& bounds = bounded.bounds;
  const double quantile =
      StudentInterval(0.0, 1.0, bounds.degrees_of_freedom, options.interval_level).upper;
  std::vector<std::optional<Interval>> asymmetric(places.size());
  ForEachIndex(places.size(), options.threads, [&](std::size_t i) {
    const auto at = static_cast<Eigen::Index>(i);
    if (!bounds.estimable[i]) return;
    asymmetric[i] = AsymmetricInterval(profile, fit, places[i], bounds.covariance(at, at), quantile,
                                       options.interval_level);
  });
  std::size_t count = 0;
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (!asymmetric[i]) continue;
    bounds.intervals[i] = *asymmetric[i];
    if (fit.unknowns.lagging && places[i] == 0)
      bounded.equation_estimates.lag->profile = asymmetric[i];
    ++count;
  }
  if (count == 0) return;
  bounded.provenance.bounds_basis += "; of " + std::to_string(count) +
                                     (count == 1 ? " unknown" : " unknowns") +
                                     " by profile likelihood, asymmetric";
}

/// Splits the unknowns at `places` into the estimates of the equations.
void Unstack(const OutputErrorFit& fit, const std::vector<Eigen::Index>& places,
             EquationEstimates& equation_estimates) {
  const SharedUnknowns& unknowns = fit.unknowns;
  if (unknowns.lagging) equation_estimates.lag = LagEstimate{fit.theta[0], LagIsAtLowerBound(fit)};
  for (const Equation equation : kEquations) {
    const std::vector<std::size_t>& excited_columns = unknowns.columns[IndexOf(equation)];
    const Eigen::Index begin = unknowns.First(equation);
    const Eigen::Index end = begin + static_cast<Eigen::Index>(excited_columns.size());
    const auto first = std::lower_bound(places.begin(), places.end(), begin);
    const auto last = std::lower_bound(first, places.end(), end);
    const std::vector<Eigen::Index> own(first, last);
    std::vector<std::size_t> columns;
    for (const Eigen::Index place : own) {
      columns.push_back(excited_columns[static_cast<std::size_t>(place - begin)]);
    }
    PlaceEstimate(equation, columns, fit.theta(own), first - places.begin(), equation_estimates);
  }
}

Refusal WarnOfMisspecification(double ratio) {
  std::ostringstream reason;
  reason.precision(2);
  reason << "hold less often than they say: a disturbance or a model error shows besides "
            "sensor noise (standard errors by cluster "
         << ratio << " times the naive ones, " << kLargestAcceptedMisspecification
         << " is accepted), and no covariance shows its effect on the estimates";
  return {"bounds", reason.str(),
          "ask for --estimator weak-iv, whose bounds hold under disturbances"};
}

Refusal WarnOfNoConvergence() {
  return {"model", "output error did not converge",
          "record more varied manoeuvres, or ask for --estimator weak-iv"};
}

std::string InWords(const FittedOutputError& fitted) {
  std::ostringstream words;
  words.precision(3);
  words << "clusters of output-error residuals (" << fitted.fit.scores.cols()
        << "), each left out of its own fit, Student t; misspecification ratio "
        << fitted.misspecification
        << (fitted.IsWellSpecified() ? ", so nothing but sensor noise is seen"
                                     : ", so bias is left that these bounds do not cover");
  return words.str();
}

}  // namespace

bool FittedOutputError::IsWellSpecified() const {
  return fit.converged && misspecification > 0.0 &&
         misspecification <= kLargestAcceptedMisspecification;
}

Result<FittedOutputError> FitOutputError(const PreparedDataset& dataset,
                                         const RegressionOptions& regression,
                                         EquationEstimates equation_estimates,
                                         const std::optional<VesselModel>& start) {
  if (!equation_estimates.Any())
    return tl::unexpected(RefuseAllEquations(equation_estimates.refusals));
  if (auto refusal = RefuseMissingEquation(equation_estimates)) return tl::unexpected(*refusal);
  const auto columns = ExcitedColumns(equation_estimates);
  auto fit = EstimateOutputError(dataset, regression, columns,
                                 start ? *start : StartOf(dataset, regression, columns), {});
  if (!fit) return tl::unexpected(fit.error());
  const double misspecification = Misspecification(*fit);
  return FittedOutputError{std::move(equation_estimates), *std::move(fit), misspecification};
}

BoundedEstimates BoundsOf(FittedOutputError fitted, const PreparedDataset& dataset,
                          const RegressionOptions& regression, const IdentifyOptions& options) {
  const OutputErrorFit& fit = fitted.fit;
  const std::vector<Eigen::Index> places = ObservableUnknowns(fit);
  BoundedEstimates bounded;
  bounded.estimator = Estimator::kOutputError;
  bounded.provenance.bounds_basis = InWords(fitted);
  bounded.provenance.misspecification = fitted.misspecification;
  bounded.provenance.clusters = static_cast<std::size_t>(fit.scores.cols());
  bounded.bounds = BoundsAt(fit, places, options.interval_level);
  bounded.bounds.joint = JointOf(bounded.bounds);
  bounded.equation_estimates = std::move(fitted.equation_estimates);
  Unstack(fit, places, bounded.equation_estimates);
  if (fitted.IsWellSpecified()) {
    ProfileAsymmetric(OutputErrorProfile(dataset, regression, fit, {}), fit, places, options,
                      bounded);
  }
  auto& refusals = bounded.equation_estimates.refusals;
  for (const InseparableDirection& direction : fit.separability.directions) {
    refusals.push_back(Explain(direction, fit.unknowns));
  }
  if (auto warning = WarnOfFewClusters(fit.scores.cols())) {
    refusals.push_back(*std::move(warning));
  }
  if (fitted.misspecification > kLargestAcceptedMisspecification) {
    refusals.push_back(WarnOfMisspecification(fitted.misspecification));
  }
  if (!fit.converged) refusals.push_back(WarnOfNoConvergence());
  return bounded;
}

Result<BoundedEstimates> BoundOutputError(const PreparedDataset& dataset,
                                          const RegressionOptions& regression,
                                          const IdentifyOptions& options,
                                          const Progress& progress) {
  if (progress) progress("fitting output error", 0.4);
  auto fitted = FitOutputError(dataset, regression,
                               AssessExcitation(dataset, regression, options.excitation));
  if (!fitted) return tl::unexpected(fitted.error());
  return BoundsOf(*std::move(fitted), dataset, regression, options);
}

}  // namespace telltale
