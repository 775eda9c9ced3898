#include "telltale/core/diagnosis/hypotheses/scatter_fit.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace telltale {
namespace {

/// Axis j scatters row j alone.
ResponseMoments OneRowEach() {
  ResponseMoments moments;
  for (std::size_t j = 0; j < 3; ++j) {
    moments[j] = Eigen::MatrixXd::Zero(3, 3);
    moments[j](static_cast<Eigen::Index>(j), static_cast<Eigen::Index>(j)) = 1.0;
  }
  return moments;
}

/// Windows whose rows are orthogonal and have the given mean squares.
Eigen::MatrixXd WindowsOf(const Eigen::Vector3d& mean_squares) {
  Eigen::MatrixXd windows(3, 4);
  windows << 1, 1, 1, 1, 1, -1, 1, -1, 1, 1, -1, -1;
  return mean_squares.cwiseSqrt().asDiagonal() * windows;
}

TEST(ExcessCovariance, IsTheSumOfSquaredAmplitudesTimesMoments) {
  const Eigen::MatrixXd excess = ExcessCovariance({1.0, 2.0, 3.0}, OneRowEach());
  EXPECT_EQ(excess, Eigen::MatrixXd(Eigen::Vector3d(1.0, 2.0, 3.0).asDiagonal()));
}

// A row of mean square m is most likely under 1 + a^2 = m.
TEST(FitScatter, HasTheMaximumLikelihoodInClosedForm) {
  const Eigen::Vector3d mean_squares(4.0, 9.0, 2.0);
  const ScatterFit fit = FitScatter(WindowsOf(mean_squares), OneRowEach());
  EXPECT_NEAR(fit.squared_amplitudes[0], 3.0, 1e-4);
  EXPECT_NEAR(fit.squared_amplitudes[1], 8.0, 1e-4);
  EXPECT_NEAR(fit.squared_amplitudes[2], 1.0, 1e-3);
  // Each window's squares: 15 without excess, 3 by the covariance fitted.
  EXPECT_NEAR(fit.square, 4.0 * 3.0, 1e-3);
  for (const double ratio : fit.log_likelihood_ratios) {
    EXPECT_NEAR(ratio, 15.0 - 3.0 - std::log(4.0 * 9.0 * 2.0), 1e-3);
  }
}

TEST(FitScatter, FindsLittleWhereNoRowScattersMoreThanNominal) {
  const ScatterFit fit = FitScatter(WindowsOf({0.5, 0.5, 0.5}), OneRowEach());
  EXPECT_LT(fit.squared_amplitudes.maxCoeff(), 1e-3);
  EXPECT_NEAR(fit.log_likelihood_ratios.sum(), 0.0, 1e-2);
}

// Means by block 1, 2, 3, 4: the second lowest counts, times eight values.
TEST(PersistentSum, IsTheLowerQuartileOfBlocksTimesTheNumberOfValues) {
  Eigen::VectorXd values(8);
  values << 3.0, 3.0, 1.0, 1.0, 4.0, 4.0, 2.0, 2.0;
  EXPECT_DOUBLE_EQ(PersistentSum(values, {0, 0, 1, 1, 2, 2, 3, 3}), 16.0);
}

TEST(PersistentSum, DoesNotCountAGainOfOneBlockAlone) {
  Eigen::VectorXd values = Eigen::VectorXd::Zero(8);
  values[0] = 1000.0;
  EXPECT_DOUBLE_EQ(PersistentSum(values, {0, 0, 1, 1, 2, 2, 3, 3}), 0.0);
}

}  // namespace
}  // namespace telltale
