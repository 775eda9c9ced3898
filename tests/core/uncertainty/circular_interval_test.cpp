#include "telltale/core/uncertainty/circular_interval.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>
#include <Eigen/Cholesky>
#include <boost/random/normal_distribution.hpp>

#include "telltale/core/base/random.hpp"

namespace telltale {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kDegree = kPi / 180.0;

/// By von Mises' law about a direction; Mardia and Jupp 2000, section 3.5.4.
Eigen::ArrayXd VonMises(double centre_rad, double concentration) {
  constexpr int kDirections = 360;
  Eigen::ArrayXd probabilities(kDirections);
  for (int i = 0; i < kDirections; ++i) {
    probabilities[i] = std::exp(concentration * std::cos(i * kDegree - centre_rad));
  }
  return probabilities / probabilities.sum();
}

double Distance(double a_rad, double b_rad) {
  return std::abs(std::remainder(a_rad - b_rad, 2.0 * kPi));
}

// Of a large concentration it is a normal law of variance 1 / concentration.
TEST(ShortestArc, IsTheNormalIntervalOfAConcentratedLaw) {
  const CircularInterval arc = ShortestArc(VonMises(100.0 * kDegree, 100.0), 0.95);
  EXPECT_LT(Distance(arc.centre_rad, 100.0 * kDegree), 0.6 * kDegree);
  EXPECT_NEAR(arc.half_width_rad, 1.96 * 0.1, 1.0 * kDegree);
}

TEST(ShortestArc, CrossesNorth) {
  const CircularInterval arc = ShortestArc(VonMises(-2.0 * kDegree, 100.0), 0.95);
  EXPECT_NEAR(arc.centre_rad, 358.0 * kDegree, 0.6 * kDegree);
}

TEST(ShortestArc, OfTwoOppositeDirectionsIsAnAxis) {
  const Eigen::ArrayXd both =
      0.4 * VonMises(100.0 * kDegree, 100.0) + 0.6 * VonMises(280.0 * kDegree, 100.0);
  const CircularInterval axis = ShortestArc(both, 0.95);
  EXPECT_TRUE(axis.or_opposite);
  EXPECT_LT(Distance(axis.centre_rad, 280.0 * kDegree), 0.6 * kDegree);
  EXPECT_NEAR(axis.half_width_rad, 1.96 * 0.1, 1.0 * kDegree);
}

TEST(ShortestArc, OfTwoDirectionsAsideIsOneThatHoldsBoth) {
  const Eigen::ArrayXd both = 0.5 * (VonMises(0.0, 200.0) + VonMises(0.5 * kPi, 200.0));
  const CircularInterval arc = ShortestArc(both, 0.95);
  EXPECT_FALSE(arc.or_opposite);
  EXPECT_GT(arc.half_width_rad, 0.25 * kPi);
}

TEST(ShortestArc, OfAllDirectionsIsNearlyTheCircle) {
  EXPECT_NEAR(ShortestArc(Eigen::ArrayXd::Constant(72, 1.0 / 72.0), 0.95).half_width_rad,
              0.95 * kPi, 2.5 * kDegree);
}

TEST(DirectionOf, HoldsTheTruthAsOftenAsItSays) {
  const Eigen::Vector2d truth(-3.0, 4.0);
  Eigen::Matrix2d covariance;
  covariance << 0.5, 0.2, 0.2, 0.3;
  const Eigen::Matrix2d root = covariance.llt().matrixL();
  RandomEngine engine(11);
  boost::random::normal_distribution<double> normal;
  int held = 0;
  constexpr int kDraws = 2000;
  for (int i = 0; i < kDraws; ++i) {
    const Eigen::Vector2d noise(normal(engine), normal(engine));
    const CircularInterval towards = DirectionOf(truth + root * noise, covariance, 0.95);
    if (Distance(towards.centre_rad, std::atan2(4.0, -3.0)) < towards.half_width_rad) ++held;
  }
  // Four standard errors of so many draws are 2 %.
  EXPECT_NEAR(held / double{kDraws}, 0.95, 0.02);
}

TEST(DirectionOf, IsAnyDirectionOfNoVector) {
  EXPECT_EQ(DirectionOf(Eigen::Vector2d::Zero(), Eigen::Matrix2d::Identity(), 0.95).half_width_rad,
            kPi);
}

}  // namespace
}  // namespace telltale
