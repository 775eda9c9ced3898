#include "telltale/core/uncertainty/truncated_normal.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include <Eigen/Cholesky>
#include <boost/math/distributions/normal.hpp>
#include <boost/random/uniform_01.hpp>

#include "telltale/core/base/linear_algebra/covariance.hpp"
#include "telltale/core/base/random.hpp"

namespace telltale {
namespace {

constexpr int kSweeps = 5;
// Of the search for the law before its truncation: a round takes most of what is missing.
constexpr int kScalingRounds = 5;
constexpr std::size_t kScalingDraws = 1000;
// A law much wider than its box is even within it, whatever its width.
constexpr double kWidestScale = 10.0;
// Beyond so many standard deviations a tail is exponential to rounding.
constexpr double kFarTail = 6.0;
constexpr double kUnlimited = std::numeric_limits<double>::infinity();

// In double throughout: long double takes four times as long, for digits that no draw shows.
using StandardNormal = boost::math::normal_distribution<
    double, boost::math::policies::policy<boost::math::policies::promote_double<false>>>;

// A standard normal between two limits from a uniform number in (0, 1).
double Between(double low, double high, double uniform) {
  if (low > 0.0) return -Between(-high, -low, uniform);  // the lower tail keeps its digits
  const StandardNormal standard;
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

// The variables, those first whose limits cut off most.
std::vector<Eigen::Index> ByTruncation(const Eigen::VectorXd& mean,
                                       const Eigen::MatrixXd& covariance,
                                       const Eigen::VectorXd& least,
                                       const Eigen::VectorXd& greatest) {
  const Eigen::VectorXd room =
      (mean - least).cwiseMin(greatest - mean).cwiseQuotient(covariance.diagonal().cwiseSqrt());
  std::vector<Eigen::Index> order(static_cast<std::size_t>(mean.size()));
  std::iota(order.begin(), order.end(), 0);
  std::ranges::stable_sort(order, {}, [&room](Eigen::Index i) { return room[i]; });
  return order;
}

// How far `x` may move along `direction` within the limits, in its lengths.
std::pair<double, double> RoomAlong(const Eigen::Ref<const Eigen::VectorXd>& direction,
                                    const Eigen::Ref<const Eigen::VectorXd>& x,
                                    const Eigen::Ref<const Eigen::VectorXd>& least,
                                    const Eigen::Ref<const Eigen::VectorXd>& greatest) {
  double back = -kUnlimited;
  double ahead = kUnlimited;
  for (Eigen::Index j = 0; j < x.size(); ++j) {
    if (direction[j] == 0.0) continue;
    const double to_least = (least[j] - x[j]) / direction[j];
    const double to_greatest = (greatest[j] - x[j]) / direction[j];
    back = std::max(back, std::min(to_least, to_greatest));
    ahead = std::min(ahead, std::max(to_least, to_greatest));
  }
  return {back, ahead};
}

}  // namespace

Eigen::MatrixXd DrawTruncatedNormal(const Eigen::VectorXd& mean, const Eigen::MatrixXd& covariance,
                                    const Eigen::VectorXd& least, const Eigen::VectorXd& greatest,
                                    const Eigen::VectorXd& start, std::size_t count,
                                    std::uint64_t seed) {
  // A variable moves those after it along. One that lies close to a limit would keep those before
  // it from moving, hence the order.
  const std::vector<Eigen::Index> order = ByTruncation(mean, covariance, least, greatest);
  const Eigen::VectorXd from = least(order);
  const Eigen::VectorXd to = greatest(order);
  const Eigen::MatrixXd root = Eigen::MatrixXd(covariance(order, order)).llt().matrixL();
  Eigen::VectorXd x = start(order);
  Eigen::VectorXd z = root.triangularView<Eigen::Lower>().solve((start - mean)(order));
  RandomEngine engine = RandomEngine::Stream(seed, 0);
  boost::random::uniform_01<double> uniform;
  Eigen::MatrixXd draws(x.size(), static_cast<Eigen::Index>(count));
  for (Eigen::Index draw = 0; draw < draws.cols(); ++draw) {
    for (int sweep = 0; sweep < kSweeps; ++sweep) {
      for (Eigen::Index i = 0; i < x.size(); ++i) {
        const Eigen::Index moved = x.size() - i;
        const auto direction = root.col(i).tail(moved);
        const auto [back, ahead] =
            RoomAlong(direction, x.tail(moved), from.tail(moved), to.tail(moved));
        const double step =
            Between(z[i] + std::min(back, 0.0), z[i] + std::max(ahead, 0.0), uniform(engine)) -
            z[i];
        z[i] += step;
        x.tail(moved) += step * direction;
      }
      x = x.cwiseMax(from).cwiseMin(to);  // against rounding
    }
    draws(order, draw) = x;
  }
  return draws;
}

Eigen::MatrixXd CovarianceBeforeTruncation(const Eigen::VectorXd& mean,
                                           const Eigen::MatrixXd& truncated,
                                           const Eigen::VectorXd& least,
                                           const Eigen::VectorXd& greatest) {
  const Eigen::VectorXd wanted = truncated.diagonal().cwiseSqrt();
  Eigen::VectorXd scale = Eigen::VectorXd::Ones(mean.size());
  for (int round = 0; round < kScalingRounds; ++round) {
    const Eigen::MatrixXd draws = DrawTruncatedNormal(mean, Scaled(truncated, scale), least,
                                                      greatest, mean, kScalingDraws, 0);
    const Eigen::VectorXd drawn = OfColumns(draws).diagonal().cwiseSqrt();
    scale = scale.cwiseProduct(wanted.cwiseQuotient(drawn)).cwiseMin(kWidestScale);
  }
  return Scaled(truncated, scale);
}

Eigen::VectorXd MeanBeforeTruncation(const Eigen::VectorXd& estimate,
                                     const Eigen::VectorXd& unconstrained,
                                     const Eigen::MatrixXd& covariance,
                                     const std::vector<Eigen::Index>& kept) {
  if (kept.empty()) return unconstrained;
  const Eigen::VectorXd beyond = (unconstrained - estimate)(kept);
  return estimate + covariance(Eigen::all, kept) * covariance(kept, kept).ldlt().solve(beyond);
}

ConditionalNormal NormalGiven(const Eigen::VectorXd& mean, const Eigen::MatrixXd& covariance,
                              const std::vector<Eigen::Index>& given,
                              const Eigen::VectorXd& values) {
  if (given.empty()) return {mean, covariance.diagonal().cwiseSqrt()};
  const Eigen::MatrixXd across = covariance(Eigen::all, given);
  const auto factor = Eigen::MatrixXd(covariance(given, given)).ldlt();
  const Eigen::MatrixXd explained = across * factor.solve(across.transpose());
  ConditionalNormal law;
  law.mean = mean + across * factor.solve(values - mean(given));
  law.standard_deviation = (covariance - explained).diagonal().cwiseMax(0.0).cwiseSqrt();
  law.mean(given) = values;
  law.standard_deviation(given).setZero();
  return law;
}

}  // namespace telltale
