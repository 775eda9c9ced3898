#include "telltale/core/simulation/divergence.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace telltale {
namespace {

TEST(RelativeDivergence, LeavesRoomForABoatAtRest) {
  const Nu limits = kFreeRunDivergence.LimitsFor({0.0, 0.0, 0.0});
  EXPECT_TRUE(Within({0.4, -0.4, 0.4}, limits));
  EXPECT_FALSE(Within({0.4, -0.6, 0.4}, limits));
  EXPECT_FALSE(Within({std::nan(""), 0.0, 0.0}, limits));
}

TEST(RelativeDivergence, GrowsWithTheFastestVelocityOfEachKind) {
  const Nu limits = kSyntheticDatasetDivergence.LimitsFor({1.0, 0.1, 0.5});
  EXPECT_EQ(limits.u, 3.0);
  EXPECT_EQ(limits.v, 0.5);
  EXPECT_EQ(limits.r, 1.5);
}

TEST(AbsoluteDivergence, IsExceededBySpeedYawRateAndNan) {
  EXPECT_FALSE(kSimulatedManoeuvreDivergence.Exceeds({14.0, 14.0, 9.9}));
  EXPECT_TRUE(kSimulatedManoeuvreDivergence.Exceeds({15.0, 15.0, 0.0}));
  EXPECT_TRUE(kSimulatedManoeuvreDivergence.Exceeds({0.0, 0.0, -10.0}));
  EXPECT_TRUE(kSimulatedManoeuvreDivergence.Exceeds({0.0, std::nan(""), 0.0}));
}

}  // namespace
}  // namespace telltale
