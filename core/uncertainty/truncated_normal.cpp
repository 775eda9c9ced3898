#include "telltale/core/uncertainty/truncated_normal.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <boost/math/distributions/normal.hpp>
#include <boost/random/uniform_01.hpp>

#include "telltale/core/base/random.hpp"

namespace telltale {
namespace {

constexpr int kSweeps = 20;
// Beyond so many standard deviations a tail is exponential to rounding.
constexpr double kFarTail = 6.0;

// A standard normal between two limits from a uniform number in (0, 1).
double Between(double low, double high, double uniform) {
  if (low > 0.0) return -Between(-high, -low, uniform);  // the lower tail keeps its digits
  const boost::math::normal standard;
  if (high < -kFarTail) {
    const double lowest = std::max(low, high - 40.0 / -high);
    const double shrink = std::exp(high * (high - lowest));
    return std::max(high - std::log(1.0 / (shrink + uniform * (1.0 - shrink))) / -high, lowest);
  }
  const double from = std::isfinite(low) ? boost::math::cdf(standard, low) : 0.0;
  const double to = std::isfinite(high) ? boost::math::cdf(standard, high) : 1.0;
  const double p = std::clamp(from + uniform * (to - from), 1e-300, 1.0 - 1e-16);
  return std::clamp(boost::math::quantile(standard, p), low, high);
}

}  // namespace

Eigen::MatrixXd DrawTruncatedNormal(const Eigen::VectorXd& mean, const Eigen::MatrixXd& covariance,
                                    const Eigen::VectorXd& least, const Eigen::VectorXd& greatest,
                                    const Eigen::VectorXd& start, std::size_t count,
                                    std::uint64_t seed) {
  const Eigen::Index n = mean.size();
  const Eigen::MatrixXd precision = covariance.llt().solve(Eigen::MatrixXd::Identity(n, n));
  RandomEngine engine = RandomEngine::Stream(seed, 0);
  boost::random::uniform_01<double> uniform;
  Eigen::VectorXd x = start;
  Eigen::MatrixXd draws(n, static_cast<Eigen::Index>(count));
  for (Eigen::Index draw = 0; draw < draws.cols(); ++draw) {
    for (int sweep = 0; sweep < kSweeps; ++sweep) {
      for (Eigen::Index i = 0; i < n; ++i) {
        // The conditional law of one coordinate given the others.
        const double pull = precision.row(i).dot(x - mean) - precision(i, i) * (x[i] - mean[i]);
        const double centre = mean[i] - pull / precision(i, i);
        const double sigma = 1.0 / std::sqrt(precision(i, i));
        x[i] = centre + sigma * Between((least[i] - centre) / sigma, (greatest[i] - centre) / sigma,
                                        uniform(engine));
      }
    }
    draws.col(draw) = x;
  }
  return draws;
}

Eigen::VectorXd MeanBeforeTruncation(const Eigen::VectorXd& estimate,
                                     const Eigen::VectorXd& unconstrained,
                                     const Eigen::MatrixXd& covariance,
                                     const std::vector<Eigen::Index>& kept) {
  if (kept.empty()) return unconstrained;
  const Eigen::VectorXd beyond = (unconstrained - estimate)(kept);
  return estimate + covariance(Eigen::all, kept) * covariance(kept, kept).ldlt().solve(beyond);
}

Eigen::VectorXd StandardDeviationsGiven(const Eigen::MatrixXd& covariance,
                                        const std::vector<Eigen::Index>& kept) {
  if (kept.empty()) return Eigen::VectorXd::Zero(covariance.rows());
  const Eigen::MatrixXd explained =
      covariance(Eigen::all, kept) *
      covariance(kept, kept).ldlt().solve(covariance(kept, Eigen::all));
  return (covariance - explained).diagonal().cwiseMax(0.0).cwiseSqrt();
}

}  // namespace telltale
