#include "telltale/core/estimation/prediction_error/bounded_step.hpp"

#include <gtest/gtest.h>

namespace telltale {
namespace {

/// Equations 2 x + y = 3, x + 2 y = 3, solved by (1, 1).
class BoundedStepTest : public ::testing::Test {
 protected:
  Eigen::VectorXd StepBelow(double x, double y, double damping = 0.0) const {
    const Eigen::Vector2d greatest(x, y);
    return BoundedStep(start_, Eigen::Vector2d(-5.0, -5.0), greatest, information_, gradient_,
                       damping);
  }

  const Eigen::VectorXd start_ = Eigen::Vector2d(0.25, -0.5);
  const Eigen::MatrixXd information_ = Eigen::Matrix2d{{2.0, 1.0}, {1.0, 2.0}};
  const Eigen::VectorXd gradient_ = Eigen::Vector2d(3.0, 3.0);
};

TEST_F(BoundedStepTest, SolvesTheEquationsInsideTheRange) {
  EXPECT_TRUE(StepBelow(9.0, 9.0).isApprox(Eigen::Vector2d(1.0, 1.0), 1e-12));
}

// x stops at half a step, whereupon 0.5 + 2 y = 3.
TEST_F(BoundedStepTest, SolvesAnewForWhatDoesNotStopAtABound) {
  EXPECT_TRUE(StepBelow(0.75, 9.0).isApprox(Eigen::Vector2d(0.5, 1.25), 1e-12));
}

// The second bound is passed once the first one holds.
TEST_F(BoundedStepTest, StopsAtEveryBound) {
  EXPECT_TRUE(StepBelow(0.75, 0.6).isApprox(Eigen::Vector2d(0.5, 1.1), 1e-12));
}

// 4 x + y = 3, x + 4 y = 3.
TEST_F(BoundedStepTest, IsShorterWhereItIsDamped) {
  EXPECT_TRUE(StepBelow(9.0, 9.0, 1.0).isApprox(Eigen::Vector2d(0.6, 0.6), 1e-12));
}

}  // namespace
}  // namespace telltale
