#include "estimation/disturbance.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "data/savitzky_golay.hpp"
#include "estimation/residual_correlation.hpp"

namespace telltale {
namespace {

/// phi through the velocity filter: the weights with which accelerations enter a window's residual.
Eigen::VectorXd SeenWeights(const PreparedDataset& dataset, const WeakProblem& problem) {
  const SavitzkyGolay filter(dataset.options.smoothing_half_width,
                             dataset.options.smoothing_degree);
  const std::size_t centre = dataset.options.smoothing_half_width;
  const std::size_t intervals = filter.WindowLength() - 1;
  Eigen::VectorXd weights =
      Eigen::VectorXd::Zero(problem.phi.value.size() + static_cast<Eigen::Index>(intervals) - 1);
  for (Eigen::Index i = 0; i < problem.phi.value.size(); ++i) {
    for (std::size_t j = 0; j < intervals; ++j) {
      weights[i + static_cast<Eigen::Index>(j)] +=
          problem.phi.value[i] * filter.IncrementWeight(centre, j);
    }
  }
  return weights;
}

/// Products of weights so many rows apart, the middle one those of a weight with itself.
Eigen::VectorXd ProductsByLag(const Eigen::VectorXd& weights) {
  const Eigen::Index middle = weights.size() - 1;
  Eigen::VectorXd products = Eigen::VectorXd::Zero(2 * middle + 1);
  for (Eigen::Index a = 0; a < weights.size(); ++a) {
    for (Eigen::Index b = 0; b < weights.size(); ++b) {
      products[middle + a - b] += weights[a] * weights[b];
    }
  }
  return products;
}

/// Autocovariance by window lag of a unit Gauss-Markov process seen through weights with these
/// products, up to the lag at which next to nothing is left of it.
Eigen::VectorXd SeenAutocovariance(const Eigen::VectorXd& products, double h, std::size_t stride,
                                   double time_constant_s) {
  constexpr double kLongestInTimeConstants = 5.0;
  const Eigen::Index middle = products.size() / 2;
  const double window_s = h * static_cast<double>(stride);
  const double reach_s =
      kLongestInTimeConstants * time_constant_s + h * static_cast<double>(products.size());
  Eigen::VectorXd seen = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(reach_s / window_s) + 1);
  for (Eigen::Index l = 0; l < seen.size(); ++l) {
    for (Eigen::Index d = -middle; d <= middle; ++d) {
      const double apart_s =
          std::abs(static_cast<double>(d) * h + static_cast<double>(l) * window_s);
      seen[l] += products[middle + d] * std::exp(-apart_s / time_constant_s);
    }
  }
  return seen;
}

/// Time constants to choose from.
std::vector<double> TimeConstants() {
  constexpr double kShortestS = 0.2;
  constexpr double kLongestS = 40.0;
  constexpr int kSteps = 30;
  std::vector<double> all;
  for (int i = 0; i <= kSteps; ++i) {
    all.push_back(kShortestS * std::pow(kLongestS / kShortestS, static_cast<double>(i) / kSteps));
  }
  return all;
}

/// For each time constant the best variance of one axis, and what it leaves of the autocovariance
/// shown, as a share of the residual variance squared.
struct AxisFits {
  Eigen::VectorXd variance;
  Eigen::VectorXd misfit;
};

/// units: what a disturbance of variance one shows, by time constant.
AxisFits FitAxis(const Eigen::VectorXd& shown, double residual_variance,
                 const std::vector<Eigen::VectorXd>& units) {
  AxisFits fits{Eigen::VectorXd(static_cast<Eigen::Index>(units.size())),
                Eigen::VectorXd(static_cast<Eigen::Index>(units.size()))};
  for (std::size_t i = 0; i < units.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    fits.variance[at] = std::max(0.0, units[i].dot(shown) / units[i].squaredNorm());
    fits.misfit[at] = (shown - fits.variance[at] * units[i]).squaredNorm() /
                      (residual_variance * residual_variance);
  }
  return fits;
}

}  // namespace

std::array<Eigen::VectorXd, 3> ResidualsOf(const WeakFit& fit, const Eigen::VectorXd& theta,
                                           const PreparedDataset& dataset,
                                           const WeakProblem& problem) {
  const FilteredThrust thrust =
      FilterThrust(dataset, problem, fit.time_constant_s ? std::optional(theta[0]) : std::nullopt);
  std::array<Eigen::VectorXd, 3> residuals;
  for (std::size_t j = 0; j < 3; ++j) {
    if (!fit.equations[j]) continue;
    const WeakWindows& windows = problem.windows[j];
    const RegressorRows rows = RowsOf(dataset, problem, thrust, kEquations[j]);
    Eigen::VectorXd of_columns = Eigen::VectorXd::Zero(rows.cols());
    const auto [begin, size] = fit.BlockOf(j);
    of_columns(fit.equations[j]->columns) = theta.segment(begin, size);
    residuals[j] = WeighAcceleration(problem, windows, dataset, kEquations[j]) -
                   Weigh(problem, windows, rows) * of_columns;
  }
  return residuals;
}

Disturbance EstimateDisturbance(const PreparedDataset& dataset, const WeakFit& fit,
                                const std::array<Eigen::VectorXd, 3>& by_sensors) {
  // An axis whose residuals are mostly noise says little of its own time constant: the other axes
  // then speak for it, since what pushes a boat pushes all three.
  constexpr double kSayOfOthers = 0.25;
  const WeakProblem& problem = fit.problem;
  const Eigen::VectorXd products = ProductsByLag(SeenWeights(dataset, problem));
  const std::vector<double> time_constants = TimeConstants();
  std::vector<Eigen::VectorXd> seen;
  for (const double tau : time_constants) {
    seen.push_back(
        SeenAutocovariance(products, dataset.sampling_period_s, problem.phi.stride, tau));
  }
  std::array<std::optional<AxisFits>, 3> fits;
  Eigen::VectorXd all = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(seen.size()));
  for (std::size_t j = 0; j < 3; ++j) {
    if (!fit.equations[j]) continue;
    const WeakEstimate& estimate = *fit.equations[j];
    const auto runs = RunsOf(problem.windows[j].first_rows, problem.phi.stride);
    const auto [begin, size] = fit.BlockOf(j);
    const Eigen::MatrixXd response = estimate.G * fit.bread.block(begin, begin, size, size);
    std::vector<Eigen::VectorXd> units;
    for (const Eigen::VectorXd& of_tau : seen) {
      units.push_back(LeftByFit(runs, of_tau, response, estimate.Z, kDisturbanceLags));
    }
    const Eigen::VectorXd shown = Autocovariance(runs, estimate.residual, kDisturbanceLags);
    fits[j] = FitAxis(shown - by_sensors[j], shown[0], units);
    all += fits[j]->misfit;
  }
  Disturbance disturbance;
  for (std::size_t j = 0; j < 3; ++j) {
    if (!fits[j]) continue;
    Eigen::Index best = 0;
    (fits[j]->misfit + kSayOfOthers * (all - fits[j]->misfit)).minCoeff(&best);
    const auto axis = static_cast<Eigen::Index>(j);
    disturbance.sigma[axis] = std::sqrt(fits[j]->variance[best]);
    disturbance.time_constant_s[axis] = time_constants[static_cast<std::size_t>(best)];
  }
  return disturbance;
}

}  // namespace telltale
