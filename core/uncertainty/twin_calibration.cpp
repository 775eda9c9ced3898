#include "uncertainty/twin_calibration.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "contract.hpp"
#include "linear_algebra/covariance.hpp"
#include "linear_algebra/decompositions.hpp"
#include "median.hpp"
#include "uncertainty/joint_bounds.hpp"
#include "uncertainty/laws.hpp"

namespace telltale {
namespace {

constexpr double kCalibratedAt = 0.95;
constexpr double kMedianToSigma = 1.4826;
constexpr double kBelievedInPart = 0.6;  // of the logarithm of a factor below one

double Quantile(std::vector<double> values, double share) {
  const auto at = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + at, values.end());
  return values[static_cast<std::size_t>(at)];
}

double MedianSize(std::vector<double> values, double about) {
  for (double& value : values) value = std::abs(value - about);
  return Median(std::move(values));
}

/// The errors in standard errors of the twin's own clusters: one that knows it knows little proves
/// nothing wild.
Eigen::VectorXd InItsOwn(const Sighting& sighting) {
  return sighting.error.cwiseQuotient(sighting.covariance.diagonal().cwiseSqrt());
}

/// Weights of the twins, below one for those that lie wildly apart from the rest in any direction:
/// where instruments are weak a single twin can be off by any amount. A twin is weighed as a whole,
/// since coefficients err together: drawn in one by one they would no longer fit each other.
std::vector<double> WeighWild(const std::vector<Sighting>& sightings) {
  constexpr double kWild = 4.0;
  std::vector<double> weights(sightings.size(), 1.0);
  for (Eigen::Index j = 0; j < sightings.front().error.size(); ++j) {
    std::vector<double> values;
    for (const Sighting& s : sightings) values.push_back(InItsOwn(s)[j]);
    const double middle = Median(values);
    const double reach = kWild * kMedianToSigma * MedianSize(values, middle);
    for (std::size_t i = 0; i < values.size(); ++i) {
      const double off = std::abs(values[i] - middle);
      if (off > reach) weights[i] = std::min(weights[i], reach / off);
    }
  }
  return weights;
}

/// What twins err by in standard errors of their own: weighed mean, and root mean square about it.
struct Spread {
  Eigen::VectorXd mean;
  Eigen::VectorXd size;
};

Spread SpreadOf(const std::vector<Sighting>& sightings, const std::vector<double>& weights) {
  constexpr double kMost = 4.0;
  const double n = std::accumulate(weights.begin(), weights.end(), 0.0);
  const Eigen::Index p = sightings.front().error.size();
  Spread spread{Eigen::VectorXd::Zero(p), Eigen::VectorXd::Zero(p)};
  for (std::size_t i = 0; i < weights.size(); ++i) {
    spread.mean += weights[i] / n * InItsOwn(sightings[i]);
  }
  for (std::size_t i = 0; i < weights.size(); ++i) {
    const Eigen::VectorXd off = (InItsOwn(sightings[i]) - spread.mean).cwiseAbs();
    spread.size += weights[i] / (n - 1.0) * off.cwiseMin(kMost).cwiseAbs2();
  }
  spread.size = spread.size.cwiseSqrt();
  return spread;
}

/// How much further a boat lies from the mean of so many twins than from where all would lie: their
/// mean errs along the very directions in which single twins do.
double ByFew(std::size_t twins) {
  return std::sqrt(1.0 + 1.0 / static_cast<double>(twins));
}

/// Each twin as the true boat stands to all of them: its error about the mean of the others and
/// its clusters' covariance, which take their sizes from the others; as unknowns.
std::vector<Sighting> SizedByOthers(const std::vector<Sighting>& sightings,
                                    const std::vector<double>& weights,
                                    const Eigen::MatrixXd& map) {
  std::vector<Sighting> sized;
  for (std::size_t i = 0; i < sightings.size(); ++i) {
    std::vector<double> without = weights;
    without[i] = 0.0;
    const Spread spread = SpreadOf(sightings, without);
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
/// pivots to hold. That they hold too often, sized as they are, is believed in part: twins know
/// only what they were told of the boat. Never one unknown against the next of its block: where
/// some are hardly told apart the data know combinations of them, and those would be lost.
Eigen::VectorXd StretchOf(const Eigen::MatrixXd& pivots, const std::vector<Block>& blocks,
                          double promised) {
  Eigen::VectorXd stretch(pivots.cols());
  for (const auto& [begin, size] : blocks) {
    const auto of_block = pivots.middleCols(begin, size).reshaped();
    const double needed = Quantile({of_block.begin(), of_block.end()}, kCalibratedAt) / promised;
    stretch.segment(begin, size)
        .setConstant(needed > 1.0 ? needed : std::pow(needed, kBelievedInPart));
  }
  return stretch;
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
  const std::vector<double> weights = WeighWild(sightings);
  const std::vector<Sighting> sized = SizedByOthers(sightings, weights, map);
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
  const Spread spread = SpreadOf(sightings, weights);
  const Eigen::VectorXd stretch = ByFew(sightings.size()) * StretchOf(pivots, blocks, promised);
  return TwinCalibration{map * spread.mean, stretch.asDiagonal() * map * spread.size.asDiagonal(),
                         LogNormalQuantile(std::move(squares), kCalibratedAt) /
                             JointQuantile(degrees_of_freedom, unknowns, kCalibratedAt)};
}

}  // namespace telltale
