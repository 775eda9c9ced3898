#include "telltale/core/estimation/regression/residual_autocovariance.hpp"

#include <algorithm>
#include <limits>

namespace telltale {
namespace {

using Columns = Eigen::Ref<const Eigen::MatrixXd>;

/// Over pairs of residuals `lag` apart within runs, x_k . y_(k+lag) added up.
double SumOfProducts(std::span<const RowRange> runs, const Columns& x, const Columns& y,
                     std::size_t lag) {
  double sum = 0.0;
  for (const RowRange& run : runs) {
    if (run.size() <= lag) continue;
    const auto begin = static_cast<Eigen::Index>(run.begin);
    const auto count = static_cast<Eigen::Index>(run.size() - lag);
    const auto later = begin + static_cast<Eigen::Index>(lag);
    sum += x.middleRows(begin, count).cwiseProduct(y.middleRows(later, count)).sum();
  }
  return sum;
}

std::size_t PairsApart(std::span<const RowRange> runs, std::size_t lag) {
  std::size_t pairs = 0;
  for (const RowRange& run : runs) pairs += run.size() - std::min(run.size(), lag);
  return pairs;
}

/// Means over those pairs, by lag; zero for lags that no run has.
Eigen::VectorXd MeanProducts(std::span<const RowRange> runs, const Columns& x, const Columns& y,
                             std::size_t lags) {
  Eigen::VectorXd means = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(lags));
  for (std::size_t lag = 0; lag < lags; ++lag) {
    const std::size_t pairs = PairsApart(runs, lag);
    if (pairs == 0) continue;
    means[static_cast<Eigen::Index>(lag)] =
        SumOfProducts(runs, x, y, lag) / static_cast<double>(pairs);
  }
  return means;
}

}  // namespace

std::vector<RowRange> RunsOf(std::span<const std::size_t> places, std::size_t stride) {
  std::vector<RowRange> runs;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const bool follows = i > 0 && places[i] == places[i - 1] + stride;
    if (!follows) runs.push_back({i, i});
    runs.back().end = i + 1;
  }
  return runs;
}

double RowsPerIndependentRow(const Eigen::VectorXd& residual, std::span<const RowRange> runs) {
  const double squares = residual.squaredNorm();
  if (squares <= 0.0) return 1.0;
  std::size_t longest = 0;
  for (const RowRange& run : runs) longest = std::max(longest, run.size());
  double sum = -1.0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t lag = 0; lag + 1 < longest; lag += 2) {
    const double pair = (SumOfProducts(runs, residual, residual, lag) +
                         SumOfProducts(runs, residual, residual, lag + 1)) /
                        squares;
    if (pair <= 0.0) break;
    least = std::min(least, pair);
    sum += 2.0 * least;
  }
  return std::max(1.0, sum);
}

Eigen::VectorXd Autocovariance(std::span<const RowRange> runs, const Eigen::VectorXd& residual,
                               std::size_t lags) {
  return MeanProducts(runs, residual, residual, lags);
}

Eigen::VectorXd DefiniteAutocovariance(std::span<const RowRange> runs,
                                       const Eigen::VectorXd& residual, std::size_t lags) {
  const auto count = static_cast<double>(PairsApart(runs, 0));
  Eigen::VectorXd covariance(static_cast<Eigen::Index>(lags));
  for (std::size_t lag = 0; lag < lags; ++lag) {
    const double weight = 1.0 - static_cast<double>(lag) / static_cast<double>(lags);
    covariance[static_cast<Eigen::Index>(lag)] =
        weight * SumOfProducts(runs, residual, residual, lag) / count;
  }
  return covariance;
}

Eigen::MatrixXd Correlate(std::span<const RowRange> runs, const Eigen::VectorXd& autocovariance,
                          const Eigen::MatrixXd& X) {
  Eigen::MatrixXd VX = Eigen::MatrixXd::Zero(X.rows(), X.cols());
  for (const RowRange& run : runs) {
    const auto begin = static_cast<Eigen::Index>(run.begin);
    const auto size = static_cast<Eigen::Index>(run.size());
    VX.middleRows(begin, size) = autocovariance[0] * X.middleRows(begin, size);
    for (Eigen::Index l = 1; l < std::min(size, autocovariance.size()); ++l) {
      const Eigen::Index count = size - l;
      VX.middleRows(begin, count) += autocovariance[l] * X.middleRows(begin + l, count);
      VX.middleRows(begin + l, count) += autocovariance[l] * X.middleRows(begin, count);
    }
  }
  return VX;
}

Eigen::VectorXd AutocovarianceAfterFit(std::span<const RowRange> runs,
                                       const Eigen::VectorXd& autocovariance,
                                       const Eigen::MatrixXd& response, const Eigen::MatrixXd& Z,
                                       std::size_t lags) {
  // Cov(e) = V - R (VZ)' - (VZ) R' + R Z'VZ R' = V - R U' - U R', R the response.
  Eigen::MatrixXd U = Correlate(runs, autocovariance, Z);
  const Eigen::MatrixXd ZVZ = Z.transpose() * U;
  U.noalias() -= response * (0.5 * ZVZ);
  Eigen::VectorXd left = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(lags));
  const Eigen::Index known = std::min(left.size(), autocovariance.size());
  left.head(known) = autocovariance.head(known);
  return left - MeanProducts(runs, response, U, lags) - MeanProducts(runs, U, response, lags);
}

}  // namespace telltale
