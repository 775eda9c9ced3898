#include "telltale/core/vessel/propellers.hpp"

#include <gtest/gtest.h>

namespace telltale {
namespace {

TEST(PwmChannel, MapsNeutralAndBothEnds) {
  const PwmChannel channel{1511, 1911, 1111};
  EXPECT_DOUBLE_EQ(channel.Normalise(1511), 0.0);
  EXPECT_DOUBLE_EQ(channel.Normalise(1911), 1.0);
  EXPECT_DOUBLE_EQ(channel.Normalise(1111), -1.0);
  EXPECT_DOUBLE_EQ(channel.Normalise(1711), 0.5);
}

TEST(PwmChannel, ReversedChannelGoesForwardBelowNeutral) {
  const PwmChannel channel{1511, 1111, 1911};
  EXPECT_DOUBLE_EQ(channel.Normalise(1111), 1.0);
  EXPECT_DOUBLE_EQ(channel.Normalise(1911), -1.0);
  EXPECT_DOUBLE_EQ(channel.Normalise(1411), 0.25);
}

TEST(PwmChannel, ClipsBeyondFullCommand) {
  const PwmChannel channel{1500, 1900, 1100};
  EXPECT_DOUBLE_EQ(channel.Normalise(2100), 1.0);
  EXPECT_DOUBLE_EQ(channel.Normalise(900), -1.0);
}

TEST(PwmChannel, PulseWidthUndoesNormalise) {
  for (const PwmChannel& channel : {PwmChannel{1500, 1900, 1100}, PwmChannel{1480, 1000, 1950}}) {
    for (double delta = -1.0; delta <= 1.0; delta += 0.125) {
      EXPECT_NEAR(channel.Normalise(channel.PulseWidth(delta)), delta, 1e-12);
    }
  }
}

TEST(DeadZone, CountsCommandsFromItsLimits) {
  const DeadZone zone{0.07, -0.05};
  EXPECT_DOUBLE_EQ(zone.Apply(0.5), 0.43);
  EXPECT_DOUBLE_EQ(zone.Apply(-0.5), -0.45);
  EXPECT_DOUBLE_EQ(zone.Apply(0.07), 0.0);
  EXPECT_DOUBLE_EQ(zone.Apply(0.03), 0.0);
  EXPECT_DOUBLE_EQ(zone.Apply(-0.05), 0.0);
  EXPECT_DOUBLE_EQ(DeadZone{}.Apply(0.3), 0.3);
}

TEST(PropellerRegion, FollowsTheSignOfEachCommand) {
  EXPECT_EQ(RegionOf({0.3, 0.2}), PropellerRegion::kFF);
  EXPECT_EQ(RegionOf({0.0, 0.0}), PropellerRegion::kFF);
  EXPECT_EQ(RegionOf({0.3, -0.2}), PropellerRegion::kFR);
  EXPECT_EQ(RegionOf({-0.3, 0.2}), PropellerRegion::kRF);
  EXPECT_EQ(RegionOf({-0.3, -0.2}), PropellerRegion::kRR);
}

/// A BlueBoat idles at 1510 us under a neutral of 1511 us: nothing turns in reverse.
TEST(PropellerRegion, CountsAnIdlePropellerAsForward) {
  EXPECT_EQ(RegionOf({-0.0025, 0.0025}), PropellerRegion::kFF);
  EXPECT_EQ(RegionOf({-0.02, 0.02}), PropellerRegion::kRF);
}

}  // namespace
}  // namespace telltale
