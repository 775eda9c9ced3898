#include "telltale/core/uncertainty/constrained_estimate.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>
#include <boost/random/normal_distribution.hpp>

#include "telltale/core/base/random.hpp"

namespace telltale {
namespace {

constexpr double kNone = std::numeric_limits<double>::infinity();

// Two parameters that the data tell by their sum, of which the second one is nothing or more.
struct SharedDrag {
  Eigen::Vector2d truth;
  double correlation;

  ConstrainedEstimate Estimated(RandomEngine& engine) const {
    ConstrainedEstimate e;
    Eigen::Matrix2d covariance;
    covariance << 1.0, correlation, correlation, 1.0;
    boost::random::normal_distribution<double> normal;
    const double first = normal(engine);
    const Eigen::Vector2d white(first, normal(engine));
    const Eigen::Vector2d unconstrained = truth + covariance.llt().matrixL() * white;
    e.covariance = covariance;
    e.unconstrained = unconstrained;
    e.least = Eigen::Vector2d(-kNone, 0.0);
    e.greatest = Eigen::Vector2d::Constant(kNone);
    // Most likely within the range: where the second one is at its end, the first one given that.
    const double beyond = std::min(unconstrained[1], 0.0);
    e.estimate = unconstrained - beyond * covariance.col(1);
    return e;
  }
};

class IntervalsBesideAnEnd : public testing::TestWithParam<double> {};

TEST_P(IntervalsBesideAnEnd, HoldTheTruth) {
  constexpr int kReplicates = 2000;
  // Four standard errors of a share of 0.95.
  const double tolerance = 4.0 * std::sqrt(0.95 * 0.05 / kReplicates);
  const SharedDrag boat{{5.0, GetParam()}, -0.95};
  RandomEngine engine = RandomEngine::Stream(11, 0);
  Eigen::Vector2d held = Eigen::Vector2d::Zero();
  for (int replicate = 0; replicate < kReplicates; ++replicate) {
    const ConstrainedEstimate estimate = boat.Estimated(engine);
    const auto draws = DrawsOf(estimate, 400, static_cast<std::uint64_t>(replicate));
    const auto intervals = IntervalsOf(estimate, draws, 0.95);
    for (Eigen::Index i = 0; i < 2; ++i) {
      const Interval& interval = intervals[static_cast<std::size_t>(i)];
      held[i] += interval.lower <= boat.truth[i] && boat.truth[i] <= interval.upper ? 1.0 : 0.0;
    }
  }
  EXPECT_GT(held[0] / kReplicates, 0.95 - tolerance);
  EXPECT_GT(held[1] / kReplicates, 0.95 - tolerance);
}

// In standard errors from the end of its range.
INSTANTIATE_TEST_SUITE_P(OfTheOtherParameter, IntervalsBesideAnEnd,
                         testing::Values(0.0, 0.5, 1.0, 2.0, 5.0));

TEST(IntervalsBesideAnEnd, AreNormalWhereEveryEndIsFar) {
  RandomEngine engine = RandomEngine::Stream(12, 0);
  const ConstrainedEstimate estimate = SharedDrag{{5.0, 10.0}, -0.95}.Estimated(engine);
  const auto intervals = IntervalsOf(estimate, DrawsOf(estimate, 20000, 13), 0.95);
  for (std::size_t i = 0; i < 2; ++i) {
    const double middle = estimate.estimate[static_cast<Eigen::Index>(i)];
    // Four standard errors of a quantile of 20000 draws, sqrt(0.025 0.975 / 20000) / 0.058.
    EXPECT_NEAR(intervals[i].lower, middle - 1.96, 0.08);
    EXPECT_NEAR(intervals[i].upper, middle + 1.96, 0.08);
  }
}

}  // namespace
}  // namespace telltale
