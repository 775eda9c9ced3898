#include <gtest/gtest.h>

#include "telltale/core/effects/effect.hpp"

namespace telltale {
namespace {

NuDot AddedAtRest(const std::vector<double>& values) {
  InstantState instant;
  instant.psi_rad = 0.7;
  return FindEffect("wind")->AddedAcceleration(values, instant);
}

// Drag goes with the square of the speed, so a boat at rest feels no difference between wind that
// is twice as fast and drag that is four times as large: only the prior of the drag tells them
// apart.
TEST(Wind, OfTwiceTheSpeedActsOnABoatAtRestAsDragFourTimesAsLarge) {
  const NuDot faster = AddedAtRest({6.0, -4.0, 0.9, 0.5, 0.1, 0.5});
  const NuDot larger = AddedAtRest({3.0, -2.0, 0.9, 0.5, 0.1, 2.0});
  EXPECT_NEAR(faster.u, larger.u, 1e-12);
  EXPECT_NEAR(faster.v, larger.v, 1e-12);
  EXPECT_NEAR(faster.r, larger.r, 1e-12);
  EXPECT_NE(faster.u, 0.0);
}

}  // namespace
}  // namespace telltale
