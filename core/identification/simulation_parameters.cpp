#include "telltale/core/identification/simulation_parameters.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "telltale/core/base/format_number.hpp"
#include "telltale/core/base/linear_algebra/covariance.hpp"
#include "telltale/core/base/linear_algebra/eigen_decompositions.hpp"
#include "telltale/core/estimation/regression/excitation.hpp"
#include "telltale/core/estimation/regression/one_step.hpp"
#include "telltale/core/estimation/regression/regression_problem.hpp"
#include "telltale/core/identification/shrinkage.hpp"
#include "telltale/core/simulation/free_run.hpp"

namespace telltale {
namespace {

constexpr double kHorizonsS[] = {5.0, 15.0, 30.0};

/// The nearest coefficients within their bounds.
Eigen::VectorXd WithinBounds(const Identification& identification, Eigen::VectorXd theta) {
  Eigen::Index next = 0;
  for (const Coefficient& c : identification.coefficients) {
    double& value = theta[next++];
    value = std::clamp(value, c.interval.lower, c.interval.upper);
  }
  return theta;
}

/// off' Cov^-1 off over the coefficients that are bounded, off the estimates.
double SquaredDistance(const Identification& identification, const Eigen::VectorXd& theta) {
  std::vector<Eigen::Index> bounded;
  for (Eigen::Index j = 0; j < theta.size(); ++j) {
    if (std::isfinite(identification.covariance(j, j))) bounded.push_back(j);
  }
  const Eigen::MatrixXd covariance = identification.covariance(bounded, bounded);
  const Eigen::VectorXd units = covariance.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::VectorXd estimates = identification.Estimates();
  const Eigen::VectorXd off = units.cwiseProduct(theta(bounded) - estimates(bounded));
  return off.dot(Scaled(covariance, units).ldlt().solve(off));
}

RegressionProblem RegressionOf(const PreparedDataset& dataset,
                               const Identification& identification) {
  RegressionOptions options;
  options.parameterization = identification.parameterization;
  options.dead_zone = identification.dead_zone;
  options.include_reverse = true;
  return BuildRegression(dataset, options);
}

/// Root mean square of each coefficient's regressor over the recording.
Eigen::VectorXd RegressorSizes(const RegressionProblem& problem, Eigen::Index coefficients) {
  Eigen::VectorXd sizes(coefficients);
  Eigen::Index next = 0;
  for (const EquationProblem& equation : problem.equations) {
    const auto rows = static_cast<double>(std::max<Eigen::Index>(1, equation.phi.rows()));
    sizes.segment(next, equation.phi.cols()) =
        (equation.phi.colwise().norm() / std::sqrt(rows)).transpose();
    next += equation.phi.cols();
  }
  return sizes;
}

/// One-step least-squares estimates of the recording: attenuated, but seldom far from the truth.
/// Zero in an equation that cannot be estimated.
Eigen::VectorXd OneStepEstimates(const RegressionProblem& problem, Eigen::Index coefficients) {
  Eigen::VectorXd theta = Eigen::VectorXd::Zero(coefficients);
  const auto excitations = Assess(problem.equations, {});
  Eigen::Index next = 0;
  for (std::size_t j = 0; j < excitations.size(); ++j) {
    const Eigen::Index size = problem.equations[j].phi.cols();
    if (excitations[j]) {
      const EquationEstimate estimate = EstimateOneStep(*excitations[j]);
      theta.segment(next, size)(estimate.columns) = estimate.theta;
    }
    next += size;
  }
  return theta;
}

/// Largest distance of a coefficient from its estimate, in standard errors.
double LargestShift(const Identification& identification, const Eigen::VectorXd& theta) {
  double largest_shift = 0.0;
  Eigen::Index next = 0;
  for (const Coefficient& c : identification.coefficients) {
    const double off = std::abs(theta[next++] - c.estimate);
    if (off > 0.0) largest_shift = std::max(largest_shift, off / c.standard_error);
  }
  return largest_shift;
}

/// The longest horizon at which neither the free runs nor those of shorter horizons diverge,
/// because long runs are few and start from few states. Zero where some of the shortest diverge.
double LongestStableRunS(const PreparedDataset& dataset, const VesselModel& model) {
  double longest_s = 0.0;
  for (const double horizon_s : kHorizonsS) {
    const DivergenceCount count = CountDivergences(dataset, model, horizon_s);
    if (count.diverged > 0) break;
    if (count.runs > 0) longest_s = horizon_s;
  }
  return longest_s;
}

/// Candidate simulation parameters.
struct SimulationCandidate {
  Eigen::VectorXd theta;
  double stable_s = 0.0;
  double free_run_error = 0.0;
};

bool IsBetter(const SimulationCandidate& one, const SimulationCandidate& other) {
  return one.stable_s > other.stable_s ||
         (one.stable_s == other.stable_s && one.free_run_error < other.free_run_error);
}

/// Posterior means where each coefficient has a prior scale of the same acceleration, over a range
/// of accelerations, about the one-step estimates or about zero.
std::vector<Eigen::VectorXd> RegularisedCandidates(const PreparedDataset& dataset,
                                                   const Identification& identification) {
  constexpr double kMost = 4.0;  // m/s^2, rad/s^2
  constexpr int kHalvings = 13;
  const RegressionProblem problem = RegressionOf(dataset, identification);
  const Eigen::Index coefficients = std::ssize(identification.coefficients);
  const Eigen::VectorXd regressors = RegressorSizes(problem, coefficients);
  const std::array<Eigen::VectorXd, 2> prior_means = {Eigen::VectorXd::Zero(coefficients),
                                                      OneStepEstimates(problem, coefficients)};
  std::vector<Eigen::VectorXd> candidates;
  double prior_acceleration = kMost;
  for (int halving = 0; halving <= kHalvings; ++halving, prior_acceleration /= 2.0) {
    const Eigen::VectorXd sizes =
        (regressors.array() > 0.0).select(prior_acceleration * regressors.cwiseInverse(), 0.0);
    for (const Eigen::VectorXd& prior_mean : prior_means) {
      candidates.push_back(RegularisedEstimates(identification, sizes, prior_mean));
    }
  }
  return candidates;
}

/// The candidate with the longest stable runs and, among those, the least free-run error.
std::optional<SimulationCandidate> BestOf(const std::vector<Eigen::VectorXd>& candidates,
                                          const PreparedDataset& dataset,
                                          Identification identification) {
  std::optional<SimulationCandidate> best;
  for (const Eigen::VectorXd& theta : candidates) {
    identification.simulation.assign(theta.begin(), theta.end());
    const auto model = *ModelOf(identification);
    const double stable_s = LongestStableRunS(dataset, model);
    if (stable_s <= 0.0) continue;
    const SimulationCandidate candidate{theta, stable_s,
                                        FreeRunError(dataset, model, kHorizonsS[0])};
    if (!best || IsBetter(candidate, *best)) best = candidate;
  }
  return best;
}

/// The best candidate within the ellipsoid or, where there is none, clamped to the bounds.
std::optional<SimulationCandidate> BestRegularised(const PreparedDataset& dataset,
                                                   const Identification& identification) {
  std::vector<Eigen::VectorXd> candidates = RegularisedCandidates(dataset, identification);
  if (const auto squared_radius = SquaredRadius(identification)) {
    std::erase_if(candidates, [&](const Eigen::VectorXd& theta) {
      return SquaredDistance(identification, theta) > *squared_radius;
    });
  } else {
    for (Eigen::VectorXd& theta : candidates) theta = WithinBounds(identification, theta);
  }
  return BestOf(candidates, dataset, identification);
}

/// In how many runs of the shortest diverging horizon the model diverges.
std::optional<std::string> Divergence(const PreparedDataset& dataset, const VesselModel& model) {
  for (const double horizon_s : kHorizonsS) {
    const DivergenceCount count = CountDivergences(dataset, model, horizon_s);
    if (count.diverged == 0) continue;
    return "in " + std::to_string(count.diverged) + " of " + std::to_string(count.runs) +
           " runs of " + FormatNumber(horizon_s, 0) + " s over its own recording";
  }
  return std::nullopt;
}

/// Writes simulation parameters and describes them; nothing where there are none.
std::optional<std::string> Regularise(const PreparedDataset& dataset,
                                      Identification& identification) {
  if (identification.estimator == Estimator::kOneStep) return std::nullopt;
  const auto candidate = BestRegularised(dataset, identification);
  if (!candidate) return std::nullopt;
  identification.simulation.assign(candidate->theta.begin(), candidate->theta.end());
  return "simulations use parameters regularised within the confidence ellipsoid, off the "
         "estimates by " +
         FormatNumber(LargestShift(identification, candidate->theta), 1) +
         " standard errors at most, and are stable for " + FormatNumber(candidate->stable_s, 0) +
         " s";
}

}  // namespace

void FindSimulationParameters(const PreparedDataset& dataset, Identification& identification) {
  const auto model = ModelOf(identification);
  if (!model) return;
  const auto diverged = Divergence(dataset, *model);
  if (!diverged) return;
  Refusal warning{"free run", *diverged + " the model diverges with its estimates: ",
                  "record more varied manoeuvres for longer"};
  if (const auto how = Regularise(dataset, identification)) {
    warning.reason += *how;
  } else {
    warning.reason += "its bounds hold, but it cannot be simulated";
    if (identification.estimator != Estimator::kOneStep) {
      warning.advice +=
          ", or check by `validate` on another recording whether the one-step "
          "estimator's model predicts better, without bounds that hold";
    }
  }
  identification.refusals.push_back(std::move(warning));
}

}  // namespace telltale
