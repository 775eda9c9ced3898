#include "telltale/core/uncertainty/interval_calibration.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "telltale/core/base/contract.hpp"
#include "telltale/core/base/linear_algebra/covariance.hpp"
#include "telltale/core/base/linear_algebra/eigen_decompositions.hpp"
#include "telltale/core/base/median.hpp"
#include "telltale/core/uncertainty/distributions.hpp"
#include "telltale/core/uncertainty/joint_bounds.hpp"

namespace telltale {
namespace {

constexpr double kCalibrationLevel = 0.95;
constexpr double kMadToSigma = 1.4826;

double Quantile(std::vector<double> values, double share) {
  const auto at = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + at, values.end());
  return values[static_cast<std::size_t>(at)];
}

double MedianAbsoluteDeviation(std::vector<double> values, double about) {
  for (double& value : values) value = std::abs(value - about);
  return Median(std::move(values));
}

/// Replicates x directions: errors in standard errors of the replicate's own clusters. A replicate
/// with a large standard error is not an outlier.
Eigen::MatrixXd StandardisedErrors(const std::vector<ReplicateError>& replicate_errors) {
  Eigen::MatrixXd errors(std::ssize(replicate_errors), replicate_errors.front().error.size());
  for (Eigen::Index i = 0; i < errors.rows(); ++i) {
    const ReplicateError& s = replicate_errors[static_cast<std::size_t>(i)];
    errors.row(i) = s.error.cwiseQuotient(s.covariance.diagonal().cwiseSqrt());
  }
  return errors;
}

/// Weights of the replicates, below one for outliers in any direction, because with weak
/// instruments a single replicate can err by any amount. A replicate has one weight, since its
/// coefficients err together.
Eigen::VectorXd OutlierWeights(const Eigen::MatrixXd& errors) {
  constexpr double kOutlierThreshold = 4.0;
  Eigen::VectorXd weights = Eigen::VectorXd::Ones(errors.rows());
  for (const auto direction : errors.colwise()) {
    const std::vector<double> values(direction.begin(), direction.end());
    const double middle = Median(values);
    const double outlier_limit =
        kOutlierThreshold * kMadToSigma * MedianAbsoluteDeviation(values, middle);
    for (Eigen::Index i = 0; i < direction.size(); ++i) {
      const double off = std::abs(direction[i] - middle);
      if (off > outlier_limit) weights[i] = std::min(weights[i], outlier_limit / off);
    }
  }
  return weights;
}

/// Weighted mean of such errors by direction, and their root mean square about it.
struct Spread {
  Eigen::VectorXd mean;
  Eigen::VectorXd size;
};

Spread SpreadOf(const Eigen::MatrixXd& errors, const Eigen::VectorXd& weights) {
  constexpr double kMost = 4.0;
  const double n = weights.sum();
  const Eigen::VectorXd mean = errors.transpose() * weights / n;
  const Eigen::MatrixXd off = (errors.rowwise() - mean.transpose()).cwiseAbs().cwiseMin(kMost);
  return {mean, (off.cwiseAbs2().transpose() * weights / (n - 1.0)).cwiseSqrt()};
}

/// The error of the true model about the mean of n replicates has variance 1 + 1/n, because that
/// mean has errors of its own.
double FewReplicatesFactor(std::size_t parametric_replicates) {
  return std::sqrt(1.0 + 1.0 / static_cast<double>(parametric_replicates));
}

/// Each replicate in the place of the true model: its error about the mean of the others, and its
/// clusters' covariance with sizes from the others; as unknowns.
std::vector<ReplicateError> CalibratedByOthers(const std::vector<ReplicateError>& replicate_errors,
                                               const Eigen::MatrixXd& errors,
                                               const Eigen::VectorXd& weights,
                                               const Eigen::MatrixXd& map) {
  std::vector<ReplicateError> calibrated;
  for (std::size_t i = 0; i < replicate_errors.size(); ++i) {
    Eigen::VectorXd without = weights;
    without[static_cast<Eigen::Index>(i)] = 0.0;
    const Spread spread = SpreadOf(errors, without);
    const ReplicateError& s = replicate_errors[i];
    const Eigen::VectorXd own = s.covariance.diagonal().cwiseSqrt();
    const Eigen::VectorXd off = s.error - own.cwiseProduct(spread.mean);
    calibrated.push_back({map * off / FewReplicatesFactor(replicate_errors.size() - 1),
                          Mapped(map, Scaled(s.covariance, spread.size))});
  }
  return calibrated;
}

/// Sizes of errors in standard errors, replicates x unknowns.
Eigen::MatrixXd StandardisedSizes(const std::vector<ReplicateError>& calibrated) {
  Eigen::MatrixXd pivots(std::ssize(calibrated), calibrated.front().error.size());
  for (Eigen::Index i = 0; i < pivots.rows(); ++i) {
    const ReplicateError& s = calibrated[static_cast<std::size_t>(i)];
    pivots.row(i) = s.error.cwiseQuotient(s.covariance.diagonal().cwiseSqrt()).cwiseAbs();
  }
  return pivots;
}

Eigen::MatrixXd WithoutRow(const Eigen::MatrixXd& rows, Eigen::Index row) {
  Eigen::MatrixXd others(rows.rows() - 1, rows.cols());
  others << rows.topRows(row), rows.bottomRows(rows.rows() - 1 - row);
  return others;
}

/// The inflation factor of each block's standard errors with which the intervals behind the pivots
/// hold. One factor serves a whole block: the data may determine combinations of collinear
/// unknowns, and single factors would lose those.
Eigen::VectorXd InflationFactors(const Eigen::MatrixXd& pivots, const std::vector<Block>& blocks,
                                 double nominal_quantile) {
  Eigen::VectorXd inflation(pivots.cols());
  for (const auto& [begin, size] : blocks) {
    const auto of_block = pivots.middleCols(begin, size).reshaped();
    const double needed =
        Quantile({of_block.begin(), of_block.end()}, kCalibrationLevel) / nominal_quantile;
    inflation.segment(begin, size).setConstant(needed);
  }
  return inflation;
}

/// The factors by which intervals of single unknowns exceed those of inflated standard errors. The
/// next replicate lies within the k-th of n with probability k / (n + 1). With fewer than nineteen
/// replicates the largest error and the inflation give the least factor.
Eigen::VectorXd IntervalFactorsOf(const Eigen::MatrixXd& pivots, const Eigen::VectorXd& inflation,
                                  double nominal_quantile) {
  const auto n = static_cast<double>(pivots.rows());
  const double rank = std::ceil(kCalibrationLevel * (n + 1.0));
  Eigen::VectorXd factors(pivots.cols());
  for (Eigen::Index j = 0; j < pivots.cols(); ++j) {
    std::vector<double> ascending(pivots.col(j).begin(), pivots.col(j).end());
    std::ranges::sort(ascending);
    const double of_block = nominal_quantile * inflation[j];
    const double needed = rank <= n ? ascending[static_cast<std::size_t>(rank) - 1]
                                    : std::max(ascending.back(), of_block);
    factors[j] = needed / of_block;
  }
  return factors;
}

/// The quantile at `share`, more than a half, of the next value after few positive ones: by the
/// median of their logarithms and the spread above it, with Student's t for the small number.
double LogNormalQuantile(std::vector<double> values, double share) {
  const auto n = static_cast<double>(values.size());
  for (double& value : values) value = std::log(value);
  const double middle = Median(values);
  std::erase_if(values, [&](double value) { return value < middle; });
  const double sigma = kMadToSigma * MedianAbsoluteDeviation(std::move(values), middle);
  return std::exp(middle + sigma * std::sqrt(1.0 + 1.0 / n) * StudentQuantile(n - 1.0, share));
}

}  // namespace

bool IsUsable(const ReplicateError& replicate_error) {
  return replicate_error.error.allFinite() && replicate_error.covariance.allFinite() &&
         (replicate_error.covariance.diagonal().array() > 0.0).all();
}

std::optional<IntervalCalibration> CalibrateIntervals(
    const std::vector<ReplicateError>& replicate_errors, const Eigen::MatrixXd& map,
    const std::vector<Block>& blocks, double degrees_of_freedom) {
  Require(replicate_errors.size() >= 3, "at least three replicates");
  const Eigen::MatrixXd errors = StandardisedErrors(replicate_errors);
  const Eigen::VectorXd weights = OutlierWeights(errors);
  const std::vector<ReplicateError> calibrated =
      CalibratedByOthers(replicate_errors, errors, weights, map);
  const Eigen::MatrixXd pivots = StandardisedSizes(calibrated);
  if (!pivots.allFinite()) return std::nullopt;
  const double nominal_quantile =
      StudentQuantile(degrees_of_freedom, 0.5 * (1.0 + kCalibrationLevel));
  const auto unknowns = static_cast<double>(map.rows());
  std::vector<double> squares;  // of each replicate's ellipsoid, an unknown
  for (Eigen::Index i = 0; i < std::ssize(calibrated); ++i) {
    const ReplicateError& s = calibrated[static_cast<std::size_t>(i)];
    const Eigen::VectorXd off =
        s.error.cwiseQuotient(InflationFactors(WithoutRow(pivots, i), blocks, nominal_quantile));
    squares.push_back(off.dot(s.covariance.ldlt().solve(off)) / unknowns);
    if (!(squares.back() > 0.0)) return std::nullopt;
  }
  const Spread spread = SpreadOf(errors, weights);
  const Eigen::VectorXd inflation = InflationFactors(pivots, blocks, nominal_quantile);
  const Eigen::VectorXd sizes = FewReplicatesFactor(replicate_errors.size()) * inflation;
  return IntervalCalibration{map * spread.mean, sizes.asDiagonal() * map * spread.size.asDiagonal(),
                             IntervalFactorsOf(pivots, inflation, nominal_quantile),
                             LogNormalQuantile(std::move(squares), kCalibrationLevel) /
                                 JointQuantile(degrees_of_freedom, unknowns, kCalibrationLevel)};
}

}  // namespace telltale
