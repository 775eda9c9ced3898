#include "telltale/core/identification/output_error_answer.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "telltale/core/contract.hpp"
#include "telltale/core/estimation/output_error_profile.hpp"
#include "telltale/core/estimation/weak_iv.hpp"
#include "telltale/core/parallel.hpp"
#include "telltale/core/uncertainty/profile_interval.hpp"

namespace telltale {
namespace {

constexpr double kUnbounded = std::numeric_limits<double>::infinity();

/// Why not, if an equation cannot be answered.
std::optional<Refusal> RefuseWithoutAllEquations(const Answers& answers) {
  for (const Equation equation : kEquations) {
    if (answers.excitations[IndexOf(equation)]) continue;
    const auto why =
        std::find_if(answers.refusals.begin(), answers.refusals.end(),
                     [&](const Refusal& refusal) { return refusal.subject == Name(equation); });
    Require(why != answers.refusals.end(), "a refusal of every equation that is not answered");
    return Refusal{"output error",
                   "it sails the boat by all three equations at once, and " + why->subject +
                       " has none: " + why->reason,
                   why->advice + ", or ask for weak-iv, which answers them one by one"};
  }
  return std::nullopt;
}

/// Unknowns that something measured moves with: all but those that are a direction by themselves.
std::vector<Eigen::Index> Seen(const OutputErrorFit& fit) {
  std::vector<bool> seen(static_cast<std::size_t>(fit.theta.size()), true);
  for (const InseparableDirection& direction : fit.separability.directions) {
    if (direction.unknowns.size() == 1) seen[direction.unknowns.front()] = false;
  }
  if (fit.unknowns.lagging) seen.front() = true;  // a time constant is always answered
  std::vector<Eigen::Index> places;
  for (std::size_t j = 0; j < seen.size(); ++j) {
    if (seen[j]) places.push_back(static_cast<Eigen::Index>(j));
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
constexpr double kReaches = 15.0;

/// The interval of one unknown by its profile if that is badly lopsided.
std::optional<Interval> LopsidedInterval(const OutputErrorProfile& profile,
                                         const OutputErrorFit& fit, Eigen::Index unknown,
                                         double variance, double quantile, double level) {
  constexpr double kPerhapsLopsided = 1.15;
  constexpr double kBadlyLopsided = 1.25;
  const double reach = quantile * std::sqrt(variance);
  if (profile.Lopsidedness(unknown, reach) < kPerhapsLopsided) return std::nullopt;
  // A likelihood that takes residuals for white is too sharp where clusters show that they are not.
  const double sharpness = std::max(1.0, variance / NaiveCovariance(fit)(unknown, unknown));
  const double estimate = fit.theta[unknown];
  ProfileSearch search{estimate, reach, estimate - kReaches * reach, estimate + kReaches * reach};
  const bool is_lag = fit.unknowns.lagging && unknown == 0;
  if (is_lag) {
    search.lowest = kLeastTimeConstantS;
    search.highest = kLongestLagS;
  }
  Interval interval =
      ProfileInterval([&](double value) { return profile.Deviance(unknown, value); }, search,
                      sharpness * quantile * quantile, level);
  if (!is_lag && interval.lower <= search.lowest) interval.lower = -kUnbounded;
  if (!is_lag && interval.upper >= search.highest) interval.upper = kUnbounded;
  if (Lopsidedness(interval, estimate) < kBadlyLopsided) return std::nullopt;
  return interval;
}

/// Replaces intervals by those of the profile likelihood where that is badly lopsided, and says of
/// how many.
void ProfileLopsided(const OutputErrorProfile& profile, const OutputErrorFit& fit,
                     const std::vector<Eigen::Index>& places, const IdentifyOptions& options,
                     BoundedAnswers& bounded) {
  Bounds& bounds = bounded.bounds;
  const double quantile =
      StudentInterval(0.0, 1.0, bounds.degrees_of_freedom, options.interval_level).upper;
  std::vector<std::optional<Interval>> lopsided(places.size());
  ForEachIndex(places.size(), options.threads, [&](std::size_t i) {
    const auto at = static_cast<Eigen::Index>(i);
    if (!bounds.estimable[i]) return;
    lopsided[i] = LopsidedInterval(profile, fit, places[i], bounds.covariance(at, at), quantile,
                                   options.interval_level);
  });
  std::size_t count = 0;
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (!lopsided[i]) continue;
    bounds.intervals[i] = *lopsided[i];
    if (fit.unknowns.lagging && places[i] == 0) bounded.answers.lag->profile = lopsided[i];
    ++count;
  }
  if (count == 0) return;
  bounded.provenance.bounds_basis += "; of " + std::to_string(count) +
                                     (count == 1 ? " unknown" : " unknowns") +
                                     " by profile likelihood, lopsided";
}

/// Splits the unknowns at `places` into the answers they are.
void Unstack(const OutputErrorFit& fit, const std::vector<Eigen::Index>& places, Answers& answers) {
  const SharedUnknowns& unknowns = fit.unknowns;
  if (unknowns.lagging) answers.lag = AnsweredLag{fit.theta[0], LagIsAtItsLeast(fit)};
  for (const Equation equation : kEquations) {
    const std::vector<std::size_t>& sought = unknowns.columns[IndexOf(equation)];
    const Eigen::Index begin = unknowns.First(equation);
    const Eigen::Index end = begin + static_cast<Eigen::Index>(sought.size());
    const auto first = std::lower_bound(places.begin(), places.end(), begin);
    const auto last = std::lower_bound(first, places.end(), end);
    const std::vector<Eigen::Index> own(first, last);
    std::vector<std::size_t> columns;
    for (const Eigen::Index place : own) {
      columns.push_back(sought[static_cast<std::size_t>(place - begin)]);
    }
    Place(equation, columns, fit.theta(own), first - places.begin(), answers);
  }
}

Refusal WarnOfMisspecification(double ratio) {
  std::ostringstream reason;
  reason.precision(2);
  reason << "hold less often than they say: something else than the sensors keeps model and "
            "measurement apart (standard errors by cluster "
         << ratio << " times the naive ones, " << kBelievedMisspecification
         << " is believed), and what it does to the estimates no covariance shows";
  return {"bounds", reason.str(),
          "ask for --estimator weak-iv, whose bounds hold under disturbances"};
}

Refusal WarnOfNoConvergence() {
  return {"model", "output error was still creeping when it was stopped",
          "record more varied manoeuvres, or ask for --estimator weak-iv"};
}

std::string InWords(const FittedOutputError& fitted) {
  std::ostringstream words;
  words.precision(3);
  words << "clusters of output-error residuals (" << fitted.fit.scores.cols()
        << "), each left out of its own fit, Student t; misspecification ratio "
        << fitted.misspecification
        << (fitted.Believable() ? ", so nothing but sensor noise is seen"
                                : ", so bias is left that these bounds do not cover");
  return words.str();
}

}  // namespace

bool FittedOutputError::Believable() const {
  return fit.converged && misspecification > 0.0 && misspecification <= kBelievedMisspecification;
}

Result<FittedOutputError> FitOutputError(const PreparedDataset& dataset,
                                         const RegressionOptions& regression, Answers answers,
                                         const std::optional<VesselModel>& start) {
  if (!answers.Any()) return tl::unexpected(NothingAnswered(answers.refusals));
  if (auto refusal = RefuseWithoutAllEquations(answers)) return tl::unexpected(*refusal);
  const auto columns = Sought(answers);
  auto fit = EstimateOutputError(dataset, regression, columns,
                                 start ? *start : StartOf(dataset, regression, columns), {});
  if (!fit) return tl::unexpected(fit.error());
  const double misspecification = Misspecification(*fit);
  return FittedOutputError{std::move(answers), *std::move(fit), misspecification};
}

BoundedAnswers BoundsOf(FittedOutputError fitted, const PreparedDataset& dataset,
                        const RegressionOptions& regression, const IdentifyOptions& options) {
  const OutputErrorFit& fit = fitted.fit;
  const std::vector<Eigen::Index> places = Seen(fit);
  BoundedAnswers bounded;
  bounded.estimator = Estimator::kOutputError;
  bounded.provenance.bounds_basis = InWords(fitted);
  bounded.provenance.misspecification = fitted.misspecification;
  bounded.provenance.clusters = static_cast<std::size_t>(fit.scores.cols());
  bounded.bounds = BoundsAt(fit, places, options.interval_level);
  bounded.bounds.joint = JointOf(bounded.bounds);
  bounded.answers = std::move(fitted.answers);
  Unstack(fit, places, bounded.answers);
  if (fitted.Believable()) {
    ProfileLopsided(OutputErrorProfile(dataset, regression, fit, {}), fit, places, options,
                    bounded);
  }
  auto& refusals = bounded.answers.refusals;
  for (const InseparableDirection& direction : fit.separability.directions) {
    refusals.push_back(Explain(direction, fit.unknowns));
  }
  if (auto warning = WarnOfFewClusters(fit.scores.cols())) {
    refusals.push_back(*std::move(warning));
  }
  if (fitted.misspecification > kBelievedMisspecification) {
    refusals.push_back(WarnOfMisspecification(fitted.misspecification));
  }
  if (!fit.converged) refusals.push_back(WarnOfNoConvergence());
  return bounded;
}

Result<BoundedAnswers> BoundOutputError(const PreparedDataset& dataset,
                                        const RegressionOptions& regression,
                                        const IdentifyOptions& options, const Progress& progress) {
  if (progress) progress("fitting output error", 0.4);
  auto fitted =
      FitOutputError(dataset, regression, AssessAll(dataset, regression, options.excitation));
  if (!fitted) return tl::unexpected(fitted.error());
  return BoundsOf(*std::move(fitted), dataset, regression, options);
}

}  // namespace telltale
