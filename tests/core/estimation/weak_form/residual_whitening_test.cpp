#include "telltale/core/estimation/weak_form/residual_whitening.hpp"

#include <cmath>
#include <limits>

#include <Eigen/Dense>

#include <gtest/gtest.h>

#include "telltale/core/estimation/regression/residual_autocovariance.hpp"

namespace telltale {
namespace {

/// Two runs, of nine and of two residuals.
const std::vector<RowRange> kLongAndShort = {{0, 9}, {9, 11}};
constexpr Eigen::Index kResiduals = 11;

/// x(k) = f x(k - 1) + white noise of variance one: f^l / (1 - f^2) at lag l.
Eigen::VectorXd OfFirstOrder(double f, Eigen::Index lags) {
  return Eigen::VectorXd::NullaryExpr(
      lags, [f](Eigen::Index l) { return std::pow(f, static_cast<double>(l)) / (1.0 - f * f); });
}

Eigen::MatrixXd Identity() {
  return Eigen::MatrixXd::Identity(kResiduals, kResiduals);
}

/// Whatever the order beyond the first: the process is the same, and so is V at lags that the order
/// leaves out.
TEST(ResidualWhitening, LeavesAProcessWhiteOfSizeOne) {
  for (const double f : {-0.6, 0.3, 0.95}) {
    const Eigen::MatrixXd V = Correlate(kLongAndShort, OfFirstOrder(f, 9), Identity());
    for (const Eigen::Index lags : {2, 3, 6, 20}) {
      const ResidualWhitening whitening(kLongAndShort, OfFirstOrder(f, lags));
      const Eigen::MatrixXd W = whitening.Whiten(Identity());
      EXPECT_LT((W * V * W.transpose() - Identity()).cwiseAbs().maxCoeff(), 1e-12)
          << f << ' ' << lags;
      EXPECT_TRUE(W.isLowerTriangular(1e-15));
    }
  }
}

TEST(ResidualWhitening, GoesBackByTheTransposed) {
  Eigen::VectorXd autocovariance(4);
  autocovariance << 2.0, -0.7, 0.3, -0.1;
  const ResidualWhitening whitening(kLongAndShort, autocovariance);
  const Eigen::MatrixXd W = whitening.Whiten(Identity());
  EXPECT_EQ(whitening.WhitenBack(Identity()), W.transpose());
  // A moving average of as many terms as the longest order is told exactly in runs no longer.
  const std::vector<RowRange> short_runs = {{0, 4}, {4, 8}, {8, 11}};
  const ResidualWhitening in_short(short_runs, autocovariance);
  const Eigen::MatrixXd V = Correlate(short_runs, autocovariance, Identity());
  EXPECT_LT((in_short.WhitenBack(in_short.Whiten(V)) - Identity()).cwiseAbs().maxCoeff(), 1e-12);
}

/// Of a sum of two decays one weight says too little; as many as a run is long say all.
TEST(ResidualWhitening, PredictsBetterTheHigherItsOrder) {
  const Eigen::VectorXd autocovariance = OfFirstOrder(0.9, 9) + OfFirstOrder(-0.5, 9);
  const Eigen::MatrixXd V = Correlate(kLongAndShort, autocovariance, Identity());
  const auto left = [&](Eigen::Index order) -> double {
    const ResidualWhitening whitening(kLongAndShort, autocovariance.head(order + 1));
    const Eigen::MatrixXd W = whitening.Whiten(Identity());
    return (W * V * W.transpose() - Identity()).cwiseAbs().maxCoeff();
  };
  EXPECT_GT(left(1), 0.1);
  EXPECT_LT(left(8), 1e-12);
}

TEST(ResidualWhitening, ChangesNothingWhereNothingIsLeft) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  for (const double variance : {0.0, kNan}) {
    const ResidualWhitening whitening(kLongAndShort, Eigen::VectorXd::Constant(3, variance));
    EXPECT_EQ(whitening.Whiten(Identity()), Identity());
    EXPECT_EQ(whitening.WhitenBack(Identity()), Identity());
  }
}

/// Residuals that never change are foretold by the last: nothing new is no reason to divide by it.
TEST(ResidualWhitening, StaysFiniteWhereResidualsNeverChange) {
  const ResidualWhitening whitening(kLongAndShort, Eigen::VectorXd::Ones(5));
  EXPECT_TRUE(whitening.Whiten(Identity()).allFinite());
}

}  // namespace
}  // namespace telltale
