#include "telltale/core/estimation/weak_form/delay_derivatives.hpp"

#include <vector>

#include <gtest/gtest.h>

#include "support/stable_boat.hpp"

namespace telltale {
namespace {

constexpr double kPeriodS = 0.2;

class DelayDerivativesTest : public ::testing::Test {
 protected:
  Eigen::RowVector2d Over(std::size_t equation) const {
    return DelayDerivatives(dynamics_, predicted_, thrust_, kPeriodS).Over(3, equation, phi_);
  }

  double Integral() const { return phi_.value.sum(); }  // of phi

  const TestFunction phi_ = TestFunction::On(kPeriodS, {});
  const BodyDynamics dynamics_{testing::StableBoat()};
  std::vector<PredictedInstant> predicted_ = std::vector<PredictedInstant>(phi_.Rows() + 6);
  std::vector<ThrustRegressors> thrust_ = std::vector<ThrustRegressors>(phi_.Rows() + 6);
};

// int phi' tau dt = -int phi tau' dt: a delay d of thrust that grows by s a second takes s d off.
TEST_F(DelayDerivativesTest, OfCommandsIsTheSlopeOfTheThrust) {
  constexpr double kSlope = 0.3;  // of the first regressor of thrust, 1/s
  for (std::size_t k = 0; k < thrust_.size(); ++k) {
    thrust_[k].surge[0] = kSlope * kPeriodS * static_cast<double>(k);
  }
  const double by_thrust = testing::StableBoat().theta[0][5];
  EXPECT_NEAR(Over(0)[0], -by_thrust * kSlope * Integral(), 1e-6);
  EXPECT_EQ(Over(0)[1], 0.0);
}

// In a steady circle the boat accelerates to its inside, by u r in sway: fixes that are late by d
// show a sway of -u r d, and the water takes the true one.
TEST_F(DelayDerivativesTest, OfFixesInASteadyCircleIsTheDragOfTheSwayTheyHide) {
  const Nu circle{0.8, 0.0, 0.3};
  for (PredictedInstant& instant : predicted_) instant.nu = circle;
  const Eigen::Vector3d hidden(0.0, circle.u * circle.r, 0.0);
  const Eigen::Vector3d drag = dynamics_.ByVelocity(circle) * hidden;
  for (std::size_t equation = 0; equation < 3; ++equation) {
    EXPECT_NEAR(Over(equation)[1], drag[static_cast<Eigen::Index>(equation)] * Integral(), 1e-6);
    EXPECT_EQ(Over(equation)[0], 0.0);
  }
}

// A boat that speeds up straight ahead: int phi' u' dt vanishes for a constant u'.
TEST_F(DelayDerivativesTest, OfFixesStraightAheadIsTheDragOfTheSpeedTheyHide) {
  constexpr double kAcceleration = 0.05;
  for (std::size_t k = 0; k < predicted_.size(); ++k) {
    predicted_[k].nu.u = 0.2 + kAcceleration * kPeriodS * static_cast<double>(k);
  }
  double drag = 0.0;  // int phi (dF/du) u' dt
  for (Eigen::Index i = 0; i < phi_.value.size(); ++i) {
    const Nu& nu = predicted_[static_cast<std::size_t>(i) + 3].nu;
    drag += phi_.value[i] * dynamics_.ByVelocity(nu)(0, 0) * kAcceleration;
  }
  EXPECT_NEAR(Over(0)[1], drag, 1e-6);
}

}  // namespace
}  // namespace telltale
