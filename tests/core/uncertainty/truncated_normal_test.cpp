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

// x0 lies beyond its limit and takes x1 along, which it all but determines: the mean of x0 is that
// of a tail, phi(3) / Q(3) - 3 = 0.28310 beyond the limit, and x1 follows by its regression.
TEST(TruncatedNormal, TakesAlongWhatDependsOnATruncatedVariable) {
  constexpr double kCorrelation = 0.99;
  constexpr double kBeyond = 0.28310;
  Eigen::Matrix2d covariance;
  covariance << 1.0, kCorrelation, kCorrelation, 1.0;
  for (const Eigen::Index tail : {0, 1}) {
    const Eigen::Index other = 1 - tail;
    Eigen::Vector2d mean = Eigen::Vector2d::Zero();
    mean[tail] = -3.0;
    Eigen::Vector2d least = Eigen::Vector2d::Constant(-kNone);
    least[tail] = 0.0;
    const auto draws =
        DrawTruncatedNormal(mean, covariance, least, Eigen::Vector2d::Constant(kNone),
                            Eigen::Vector2d::Zero(), 20000, 4);
    // Its standard deviation is 0.266, that of x1 0.298: four standard errors of 20000 draws.
    EXPECT_NEAR(draws.row(tail).mean(), kBeyond, 4.0 * 0.266 / std::sqrt(20000.0));
    EXPECT_NEAR(draws.row(other).mean(), kCorrelation * (kBeyond + 3.0),
                4.0 * 0.298 / std::sqrt(20000.0));
  }
}

// Of two standard normals with correlation c the first quadrant has the probability
// 1/4 + asin(c) / (2 pi), and there E x0 = (1 + c) / (2 sqrt(2 pi)) / that probability.
TEST(TruncatedNormal, OfAQuadrantHasItsMean) {
  constexpr double kCorrelation = -0.9;
  Eigen::Matrix2d covariance;
  covariance << 1.0, kCorrelation, kCorrelation, 1.0;
  const auto draws =
      DrawTruncatedNormal(Eigen::Vector2d::Zero(), covariance, Eigen::Vector2d::Zero(),
                          Eigen::Vector2d::Constant(kNone), Eigen::Vector2d::Ones(), 20000, 5);
  const double probability = 0.25 + std::asin(kCorrelation) / (2.0 * M_PI);
  const double mean = (1.0 + kCorrelation) / (2.0 * std::sqrt(2.0 * M_PI)) / probability;
  // Its standard deviation is below its mean: four standard errors of 5000 independent draws.
  EXPECT_NEAR(draws.row(0).mean(), mean, 4.0 * mean / std::sqrt(5000.0));
  EXPECT_NEAR(draws.row(1).mean(), mean, 4.0 * mean / std::sqrt(5000.0));
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

// About an end of a half line the standard deviation is sqrt(1 - 2 / pi) of that of the whole line.
TEST(CovarianceBeforeTruncation, HasTheDeviationsWithinTheBox) {
  Eigen::Matrix2d truncated;
  truncated << 1.0, 0.5, 0.5, 4.0;
  const Eigen::MatrixXd before =
      CovarianceBeforeTruncation(Eigen::Vector2d(3.0, 0.0), truncated, Eigen::Vector2d(-kNone, 0.0),
                                 Eigen::Vector2d::Constant(kNone));
  // Six standard errors of a standard deviation of 1000 draws, 1 / sqrt(2000), in its square.
  EXPECT_NEAR(before(1, 1), 4.0 / (1.0 - 2.0 / M_PI), 0.27 * 4.0 / (1.0 - 2.0 / M_PI));
  EXPECT_NEAR(before(0, 1) / std::sqrt(before(0, 0) * before(1, 1)), 0.25, 1e-12);
}

TEST(CovarianceBeforeTruncation, StaysFiniteInABoxThatIsTooNarrow) {
  const Eigen::MatrixXd before = CovarianceBeforeTruncation(
      Eigen::VectorXd::Zero(1), Eigen::MatrixXd::Identity(1, 1), Eigen::VectorXd::Constant(1, -0.1),
      Eigen::VectorXd::Constant(1, 0.1));
  EXPECT_TRUE(before.allFinite());
}

TEST(NormalGiven, IsTheConditionalLaw) {
  Eigen::Matrix2d covariance;
  covariance << 1.0, 0.8, 0.8, 1.0;
  const auto law =
      NormalGiven(Eigen::Vector2d(3.0, 1.0), covariance, {1}, Eigen::VectorXd::Constant(1, 2.0));
  EXPECT_NEAR(law.mean[0], 3.8, 1e-12);                // 3 + 0.8 (2 - 1)
  EXPECT_NEAR(law.standard_deviation[0], 0.6, 1e-12);  // sqrt(1 - 0.8^2)
  EXPECT_EQ(law.mean[1], 2.0);
  EXPECT_EQ(law.standard_deviation[1], 0.0);
}

TEST(NormalGiven, IsTheLawItselfWhereNothingIsGiven) {
  const auto law = NormalGiven(Eigen::Vector2d(3.0, 1.0), Eigen::Vector2d(4.0, 9.0).asDiagonal(),
                               {}, Eigen::VectorXd());
  EXPECT_EQ(law.mean, Eigen::Vector2d(3.0, 1.0));
  EXPECT_EQ(law.standard_deviation, Eigen::Vector2d(2.0, 3.0));
}

}  // namespace
}  // namespace telltale
