#include "telltale/core/diagnosis/hypotheses/expected_separation.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "support/hand_made_diagnosis.hpp"

namespace telltale {
namespace {

// Six numbers a window, each 3 apart at a standard deviation of 2: square / expected is 9 / 4.
TEST(ExpectedSeparation, IsTheLogEvidenceInClosedForm) {
  NominalBaseline nominal = testing::UnitBaseline(6, 0, 0);
  nominal.covariance *= 4.0;
  nominal.kappa = 0.8;
  const Eigen::MatrixXd one = testing::Pattern(6, 10, 0.7);
  const Eigen::MatrixXd other = one.array() + 3.0;
  EXPECT_NEAR(ExpectedSeparation(one, other, nominal),
              0.5 * (0.5 * 0.8 * 10.0) * std::log(1.0 + 9.0 / 4.0), 1e-12);
}

TEST(ExpectedSeparation, OfEqualPredictionsIsZero) {
  const Eigen::MatrixXd one = testing::Pattern(6, 10, 0.7);
  EXPECT_EQ(ExpectedSeparation(one, one, testing::UnitBaseline(6, 0, 0)), 0.0);
}

}  // namespace
}  // namespace telltale
