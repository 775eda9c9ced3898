#include "telltale/core/uncertainty/joint_bounds.hpp"

#include <gtest/gtest.h>

#include "telltale/core/base/contract.hpp"

namespace telltale {
namespace {

/// One unknown alone: Fisher's law of 1 and n is the square of Student's of n, whose 97.5 % point
/// is 2.0003 at 60 degrees of freedom (any table).
TEST(JointBounds, OfOneUnknownAreThoseOfStudent) {
  EXPECT_NEAR(SquaredRadius({1.0, 60.0}, 1, 0.95), 2.0003 * 2.0003, 2e-4);
}

/// scipy.stats.f.ppf(0.95, 35, 45) = 1.68296; the factor multiplies.
TEST(JointBounds, OfManyFollowFisher) {
  EXPECT_NEAR(SquaredRadius({1.0, 79.0}, 35, 0.95), 35.0 * 1.68296, 1e-3);
  EXPECT_NEAR(SquaredRadius({1.5, 79.0}, 35, 0.95), 1.5 * 35.0 * 1.68296, 2e-3);
}

/// With fewer clusters than unknowns five degrees of freedom are left: scipy.stats.f.ppf(0.95, 35,
/// 5) = 4.47753.
TEST(JointBounds, FewClustersStillBound) {
  EXPECT_NEAR(SquaredRadius({1.0, 20.0}, 35, 0.95), 35.0 * 4.47753, 0.01);
}

TEST(JointBounds, OfNothingIsABrokenContract) {
  EXPECT_THROW(SquaredRadius({}, 0, 0.95), ContractViolation);
}

}  // namespace
}  // namespace telltale
