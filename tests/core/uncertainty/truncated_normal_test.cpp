#include "telltale/core/uncertainty/truncated_normal.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace telltale {
namespace {

constexpr double kNone = std::numeric_limits<double>::infinity();

TEST(TruncatedNormal, OfAHalfLineHasTheHalfNormalMoments) {
  const auto draws = DrawTruncatedNormal(
      Eigen::VectorXd::Zero(1), Eigen::MatrixXd::Identity(1, 1), Eigen::VectorXd::Zero(1),
      Eigen::VectorXd::Constant(1, kNone), Eigen::VectorXd::Zero(1), 20000, 1);
  // Mean sqrt(2 / pi), variance 1 - 2 / pi: four standard errors of 20000 draws.
  EXPECT_NEAR(draws.mean(), std::sqrt(2.0 / M_PI), 4.0 * 0.603 / std::sqrt(20000.0));
}

TEST(TruncatedNormal, WithoutLimitsHasItsCovariance) {
  Eigen::Matrix2d covariance;
  covariance << 1.0, 0.6, 0.6, 2.0;
  const Eigen::VectorXd unbounded = Eigen::VectorXd::Constant(2, kNone);
  const auto draws = DrawTruncatedNormal(Eigen::VectorXd::Zero(2), covariance, -unbounded,
                                         unbounded, Eigen::VectorXd::Zero(2), 20000, 2);
  const Eigen::MatrixXd centred = draws.colwise() - draws.rowwise().mean();
  const Eigen::Matrix2d sample = centred * centred.transpose() / 19999.0;
  // A variance of v has standard error v sqrt(2 / n) = 0.02 at most; four of those.
  EXPECT_LT((sample - covariance).cwiseAbs().maxCoeff(), 0.08);
}

TEST(TruncatedNormal, FarInATailIsExponential) {
  const auto draws = DrawTruncatedNormal(
      Eigen::VectorXd::Zero(1), Eigen::MatrixXd::Identity(1, 1), Eigen::VectorXd::Constant(1, 20.0),
      Eigen::VectorXd::Constant(1, kNone), Eigen::VectorXd::Constant(1, 20.0), 20000, 3);
  EXPECT_GE(draws.minCoeff(), 20.0);
  // The mean of the tail beyond a is a + 1 / a - 2 / a^3 + ...: 20.0498.
  EXPECT_NEAR(draws.mean(), 20.0498, 4.0 * 0.05 / std::sqrt(20000.0));
}

TEST(MeanBeforeTruncation, LeavesTheOthersAtTheirEstimatesGivenTheEnds) {
  Eigen::Matrix2d covariance;
  covariance << 1.0, 0.8, 0.8, 2.0;
  const Eigen::Vector2d estimate(2.0, 0.0);
  const Eigen::VectorXd mean =
      MeanBeforeTruncation(estimate, Eigen::Vector2d(5.0, -1.0), covariance, {1});
  EXPECT_EQ(mean[1], -1.0);
  // The mean of the first given that the second is at 0.
  EXPECT_NEAR(mean[0] + covariance(0, 1) / covariance(1, 1) * (0.0 - mean[1]), estimate[0], 1e-12);
}

TEST(MeanBeforeTruncation, IsThatWithoutConstraintsWhereNoneIsKept) {
  const Eigen::Vector2d unconstrained(5.0, -1.0);
  EXPECT_EQ(MeanBeforeTruncation(Eigen::Vector2d(2.0, 0.0), unconstrained,
                                 Eigen::Matrix2d::Identity(), {}),
            unconstrained);
}

TEST(StandardDeviationsGiven, AreThoseOfTheConditionalLaw) {
  Eigen::Matrix2d covariance;
  covariance << 1.0, 0.8, 0.8, 1.0;
  const Eigen::VectorXd given = StandardDeviationsGiven(covariance, {1});
  EXPECT_NEAR(given[0], 0.6, 1e-12);  // sqrt(1 - 0.8^2)
  EXPECT_NEAR(given[1], 0.0, 1e-12);
}

}  // namespace
}  // namespace telltale
