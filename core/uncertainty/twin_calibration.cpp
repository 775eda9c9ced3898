#include "telltale/core/uncertainty/twin_calibration.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "telltale/core/contract.hpp"
#include "telltale/core/linear_algebra/covariance.hpp"
#include "telltale/core/linear_algebra/decompositions.hpp"
#include "telltale/core/median.hpp"
#include "telltale/core/uncertainty/joint_bounds.hpp"
#include "telltale/core/uncertainty/laws.hpp"

namespace telltale {
namespace {

constexpr double kCalibratedAt = 0.95;
constexpr double kMedianToSigma = 1.4826;

double Quantile(std::vector<double> values, double share) {
  const auto at = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + at, values.end());
  return values[static_cast<std::size_t>(at)];
}

double MedianSize(std::vector<double> values, double about) {
  for (double& value : values) value = std::abs(value - about);
  return Median(std::move(values));
}

/// Twins x directions: errors in standard errors of the twin's own clusters. One that knows it
/// knows little proves nothing wild.
Eigen::MatrixXd InTheirOwn(const std::vector<Sighting>& sightings) {
  Eigen::MatrixXd errors(std::ssize(sightings), sightings.front().error.size());
  for (Eigen::Index i = 0; i < errors.rows(); ++i) {
    const Sighting& s = sightings[static_cast<std::size_t>(i)];
    errors.row(i) = s.error.cwiseQuotient(s.covariance.diagonal().cwiseSqrt());
  }
  return errors;
}

/// Weights of the twins, below one for those that lie wildly apart from the rest in any direction:
/// where instruments are weak a single twin can be off by any amount. A twin is weighed as a whole,
/// since coefficients err together: drawn in one by one they would no longer fit each other.
Eigen::VectorXd WeighWild(const Eigen::MatrixXd& errors) {
  constexpr double kWild = 4.0;
  Eigen::VectorXd weights = Eigen::VectorXd::Ones(errors.rows());
  for (const auto direction : errors.colwise()) {
    const std::vector<double> values(direction.begin(), direction.end());
    const double middle = Median(values);
    const double reach = kWild * kMedianToSigma * MedianSize(values, middle);
    for (Eigen::Index i = 0; i < direction.size(); ++i) {
      const double off = std::abs(direction[i] - middle);
      if (off > reach) weights[i] = std::min(weights[i], reach / off);
    }
  }
  return weights;
}

/// Weighed mean of such errors by direction, and their root mean square about it.
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

/// How much further a boat lies from the mean of so many twins than from where all would lie: their
/// mean errs along the very directions in which single twins do.
double ByFew(std::size_t twins) {
  return std::sqrt(1.0 + 1.0 / static_cast<double>(twins));
}

/// Each twin as the true boat stands to all of them: its error about the mean of the others and
/// its clusters' covariance, which take their sizes from the others; as unknowns.
std::vector<Sighting> SizedByOthers(const std::vector<Sighting>& sightings,
                                    const Eigen::MatrixXd& errors, const Eigen::VectorXd& weights,
                                    const Eigen::MatrixXd& map) {
  std::vector<Sighting> sized;
  for (std::size_t i = 0; i < sightings.size(); ++i) {
    Eigen::VectorXd without = weights;
    without[static_cast<Eigen::Index>(i)] = 0.0;
    const Spread spread = SpreadOf(errors, without);
    const Sighting& s = sightings[i];
    const Eigen::VectorXd own = s.covariance.diagonal().cwiseSqrt();
    const Eigen::VectorXd off = s.error - own.cwiseProduct(spread.mean);
    sized.push_back(
        {map * off / ByFew(sightings.size() - 1), Mapped(map, Scaled(s.covariance, spread.size))});
  }
  return sized;
}

/// Sizes of errors in standard errors, twins x unknowns.
Eigen::MatrixXd PivotsOf(const std::vector<Sighting>& sized) {
  Eigen::MatrixXd pivots(std::ssize(sized), sized.front().error.size());
  for (Eigen::Index i = 0; i < pivots.rows(); ++i) {
    const Sighting& s = sized[static_cast<std::size_t>(i)];
    pivots.row(i) = s.error.cwiseQuotient(s.covariance.diagonal().cwiseSqrt()).cwiseAbs();
  }
  return pivots;
}

Eigen::MatrixXd WithoutRow(const Eigen::MatrixXd& rows, Eigen::Index row) {
  Eigen::MatrixXd others(rows.rows() - 1, rows.cols());
  others << rows.topRows(row), rows.bottomRows(rows.rows() - 1 - row);
  return others;
}

/// By what the standard errors of each block have to be stretched for the intervals behind the
/// pivots to hold. Never one unknown against the next of its block: where some are hardly told
/// apart the data know combinations of them, and those would be lost.
Eigen::VectorXd StretchOf(const Eigen::MatrixXd& pivots, const std::vector<Block>& blocks,
                          double promised) {
  Eigen::VectorXd stretch(pivots.cols());
  for (const auto& [begin, size] : blocks) {
    const auto of_block = pivots.middleCols(begin, size).reshaped();
    const double needed = Quantile({of_block.begin(), of_block.end()}, kCalibratedAt) / promised;
    stretch.segment(begin, size).setConstant(needed);
  }
  return stretch;
}

/// The factors by which intervals of single unknowns are longer than those of stretched standard
/// errors: of n + 1 alike, the next twin is within the k-th of n with probability k / (n + 1). With
/// fewer than nineteen twins none of them is far enough out, and the stretch is the least.
Eigen::VectorXd IntervalFactorsOf(const Eigen::MatrixXd& pivots, const Eigen::VectorXd& stretch,
                                  double promised) {
  const auto n = static_cast<double>(pivots.rows());
  const double rank = std::ceil(kCalibratedAt * (n + 1.0));
  Eigen::VectorXd factors(pivots.cols());
  for (Eigen::Index j = 0; j < pivots.cols(); ++j) {
    std::vector<double> ascending(pivots.col(j).begin(), pivots.col(j).end());
    std::ranges::sort(ascending);
    const double of_block = promised * stretch[j];
    const double needed = rank <= n ? ascending[static_cast<std::size_t>(rank) - 1]
                                    : std::max(ascending.back(), of_block);
    factors[j] = needed / of_block;
  }
  return factors;
}

/// What the next value stays below with probability `share`, more than a half, after few positive
/// ones: by way of the middle of their logarithms and how far those above it reach, known no better
/// than so few tell.
double LogNormalQuantile(std::vector<double> values, double share) {
  const auto n = static_cast<double>(values.size());
  for (double& value : values) value = std::log(value);
  const double middle = Median(values);
  std::erase_if(values, [&](double value) { return value < middle; });
  const double sigma = kMedianToSigma * MedianSize(std::move(values), middle);
  return std::exp(middle + sigma * std::sqrt(1.0 + 1.0 / n) * StudentQuantile(n - 1.0, share));
}

}  // namespace

bool IsSound(const Sighting& sighting) {
  return sighting.error.allFinite() && sighting.covariance.allFinite() &&
         (sighting.covariance.diagonal().array() > 0.0).all();
}

std::optional<TwinCalibration> Calibrate(const std::vector<Sighting>& sightings,
                                         const Eigen::MatrixXd& map,
                                         const std::vector<Block>& blocks,
                                         double degrees_of_freedom) {
  Require(sightings.size() >= 3, "at least three twins");
  const Eigen::MatrixXd errors = InTheirOwn(sightings);
  const Eigen::VectorXd weights = WeighWild(errors);
  const std::vector<Sighting> sized = SizedByOthers(sightings, errors, weights, map);
  const Eigen::MatrixXd pivots = PivotsOf(sized);
  if (!pivots.allFinite()) return std::nullopt;
  const double promised = StudentQuantile(degrees_of_freedom, 0.5 * (1.0 + kCalibratedAt));
  const auto unknowns = static_cast<double>(map.rows());
  std::vector<double> squares;  // of each twin's ellipsoid, an unknown
  for (Eigen::Index i = 0; i < std::ssize(sized); ++i) {
    const Sighting& s = sized[static_cast<std::size_t>(i)];
    const Eigen::VectorXd off =
        s.error.cwiseQuotient(StretchOf(WithoutRow(pivots, i), blocks, promised));
    squares.push_back(off.dot(s.covariance.ldlt().solve(off)) / unknowns);
    if (!(squares.back() > 0.0)) return std::nullopt;
  }
  const Spread spread = SpreadOf(errors, weights);
  const Eigen::VectorXd stretch = StretchOf(pivots, blocks, promised);
  const Eigen::VectorXd sizes = ByFew(sightings.size()) * stretch;
  return TwinCalibration{map * spread.mean, sizes.asDiagonal() * map * spread.size.asDiagonal(),
                         IntervalFactorsOf(pivots, stretch, promised),
                         LogNormalQuantile(std::move(squares), kCalibratedAt) /
                             JointQuantile(degrees_of_freedom, unknowns, kCalibratedAt)};
}

}  // namespace telltale
