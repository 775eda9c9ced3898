#include "telltale/core/data/held_commands.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace telltale {
namespace {

// Port +1 from 0 s, -1 from 1 s, 0 from 3 s; starboard half ahead throughout.
const std::vector<ThrusterSample> kSamples = {{0, 1900, 1700}, {1, 1100, 1700}, {3, 1500, 1700}};

TEST(HeldCommands, HoldsEachUntilTheNextAndTheLastWithoutEnd) {
  const HeldCommands commands(kSamples, Vehicle{});
  EXPECT_EQ(commands.At(-5.0).port, 1.0);
  EXPECT_EQ(commands.At(0.99).port, 1.0);
  EXPECT_EQ(commands.At(1.0).port, -1.0);
  EXPECT_EQ(commands.At(99.0).port, 0.0);
  EXPECT_EQ(commands.At(99.0).starboard, 0.5);
}

TEST(HeldCommands, MeansAreWeightedByTime) {
  const HeldCommands commands(kSamples, Vehicle{});
  EXPECT_DOUBLE_EQ(commands.Mean(0.5, 1.5).port, 0.0);
  EXPECT_DOUBLE_EQ(commands.Mean(0.75, 1.75).port, -0.5);
  EXPECT_DOUBLE_EQ(commands.Mean(2.0, 4.0).port, -0.5);
  EXPECT_DOUBLE_EQ(commands.Mean(0.1, 7.3).starboard, 0.5);
}

TEST(HeldCommands, TriangularMeanWeightsTheMiddleMost) {
  const HeldCommands commands(kSamples, Vehicle{});
  EXPECT_NEAR(commands.TriangularMean(1.0, 0.5).port, 0.0, 1e-15);
  // Up to the switch at half the half width before the centre: 1/8 of the triangle's area.
  EXPECT_NEAR(commands.TriangularMean(1.5, 1.0).port, 0.125 - 0.875, 1e-15);
  EXPECT_NEAR(commands.TriangularMean(1.5, 1.0).starboard, 0.5, 1e-15);
}

TEST(HeldCommands, ChangesOfTheirTimesKeepTheirOrder) {
  HeldCommands commands(kSamples, Vehicle{});
  const std::vector<double> before = {0.0, 1.0};  // as recorded, whatever the change made of them
  std::size_t next = 0;
  commands.ForEachTime([&](double before_s, double time_s) {
    EXPECT_EQ(before_s, before[next++]);
    return time_s - 1.5;
  });
  EXPECT_EQ(commands.Times(), (std::vector<double>{0.0, 0.0, 1.5}));
}

TEST(HeldCommands, RegionIsThatInForceForMostOfTheTime) {
  const HeldCommands commands(kSamples, Vehicle{});
  EXPECT_EQ(commands.MajorityRegion(0.0, 1.4), PropellerRegion::kFF);
  EXPECT_EQ(commands.MajorityRegion(0.8, 1.4), PropellerRegion::kRF);
  EXPECT_EQ(commands.MajorityRegion(0.5, 1.5), PropellerRegion::kFF) << "the earlier of equals";
}

}  // namespace
}  // namespace telltale
