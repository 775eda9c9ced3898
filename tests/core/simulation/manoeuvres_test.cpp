#include "telltale/core/simulation/manoeuvres.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "telltale/core/simulation/manoeuvre_catalogue.hpp"

namespace telltale {
namespace {

double Duration(const Manoeuvre& manoeuvre) {
  double sum_s = 0.0;
  for (const HeldCommand& held : manoeuvre) sum_s += held.duration_s;
  return sum_s;
}

TEST(Manoeuvres, StaircaseGoesUpAndDownOnce) {
  const Manoeuvre staircase = SurgeStaircase(0.2, 0.8, 4, 5.0);
  const double expected[] = {0.2, 0.4, 0.6, 0.8, 0.6, 0.4, 0.2};
  ASSERT_EQ(staircase.size(), std::size(expected));
  for (std::size_t i = 0; i < staircase.size(); ++i) {
    EXPECT_NEAR(staircase[i].delta.port, expected[i], 1e-15);
    EXPECT_EQ(staircase[i].delta.starboard, staircase[i].delta.port);
    EXPECT_EQ(staircase[i].duration_s, 5.0);
  }
}

TEST(Manoeuvres, ZigzagAndCircleKeepMeanAndDifference) {
  const Manoeuvre zigzag = Zigzag(0.5, 0.4, 2, 3.0);
  ASSERT_EQ(zigzag.size(), 4u);
  for (std::size_t i = 0; i < zigzag.size(); ++i) {
    EXPECT_NEAR(zigzag[i].delta.Mean(), 0.5, 1e-15);
    EXPECT_NEAR(zigzag[i].delta.Difference(), i % 2 == 0 ? 0.4 : -0.4, 1e-15);
  }
  EXPECT_NEAR(Circle(0.6, -0.2, 9.0).front().delta.Difference(), -0.2, 1e-15);
}

TEST(Manoeuvres, SpinsGoThroughBothMixedRegions) {
  const Manoeuvre spins = Spins(0.4, 6.0);
  EXPECT_EQ(RegionOf(spins[0].delta), PropellerRegion::kFR);
  EXPECT_EQ(RegionOf(spins[1].delta), PropellerRegion::kRF);
}

TEST(Manoeuvres, SpiralGoesFromOneTurnToTheOtherAndBack) {
  const Manoeuvre spiral = Spiral(0.5, 0.6, 3, 9.0);
  const double expected[] = {-0.6, 0.0, 0.6, 0.0, -0.6};
  ASSERT_EQ(spiral.size(), std::size(expected));
  for (std::size_t i = 0; i < spiral.size(); ++i) {
    EXPECT_NEAR(spiral[i].delta.Difference(), expected[i], 1e-15);
    EXPECT_NEAR(spiral[i].delta.Mean(), 0.5, 1e-15);
  }
}

TEST(Manoeuvres, RepeatedEndsOnTime) {
  const Manoeuvre repeated = Repeated(SurgeSteps(0.2, 0.9, 1, 4.0), 30.0);
  ASSERT_EQ(repeated.size(), 8u);
  EXPECT_EQ(repeated.back().duration_s, 2.0);
  EXPECT_EQ(repeated.back().delta.port, 0.9);
  EXPECT_NEAR(Duration(repeated), 30.0, 1e-12);
}

TEST(Manoeuvres, TheCatalogueKeepsCommandsInRange) {
  std::map<std::string_view, int> names;
  for (const CatalogueManoeuvre& entry : ManoeuvreCatalogue()) {
    EXPECT_EQ(++names[entry.name], 1) << entry.name;
    EXPECT_FALSE(entry.how.empty());
    EXPECT_NEAR(Duration(entry.manoeuvre), kCatalogueDurationS, 1e-9) << entry.name;
    for (const HeldCommand& held : entry.manoeuvre) {
      EXPECT_LE(std::abs(held.delta.port), 1.0 + 1e-12) << entry.name;
      EXPECT_LE(std::abs(held.delta.starboard), 1.0 + 1e-12) << entry.name;
      EXPECT_GT(held.duration_s, 0.0) << entry.name;
    }
  }
}

TEST(Manoeuvres, RandomStepsKeepTheirRangeAndDuration) {
  const CommandRange range{{0.1, -0.8}, {0.9, -0.2}};
  const Manoeuvre steps = RandomSteps(range, 1.0, 3.0, 100.0, 7);
  EXPECT_NEAR(Duration(steps), 100.0, 1e-9);
  for (std::size_t i = 0; i < steps.size(); ++i) {
    EXPECT_GE(steps[i].delta.port, 0.1 - 1e-12);
    EXPECT_LE(steps[i].delta.port, 0.9 + 1e-12);
    EXPECT_GE(steps[i].delta.starboard, -0.8 - 1e-12);
    EXPECT_LE(steps[i].delta.starboard, -0.2 + 1e-12);
    EXPECT_LE(steps[i].duration_s, 3.0 + 1e-12);
    const bool cut_short = i + 1 == steps.size();
    EXPECT_GE(steps[i].duration_s, cut_short ? 0.0 : 1.0 - 1e-12);
  }
}

TEST(Manoeuvres, RandomStepsFollowTheirSeed) {
  const CommandRange range{{0.0, 0.0}, {1.0, 1.0}};
  const Manoeuvre one = RandomSteps(range, 1.0, 3.0, 60.0, 1);
  const Manoeuvre same = RandomSteps(range, 1.0, 3.0, 60.0, 1);
  const Manoeuvre other = RandomSteps(range, 1.0, 3.0, 60.0, 2);
  ASSERT_EQ(one.size(), same.size());
  bool differs = one.size() != other.size();
  for (std::size_t i = 0; i < one.size(); ++i) {
    EXPECT_EQ(one[i].delta.port, same[i].delta.port);
    EXPECT_EQ(one[i].duration_s, same[i].duration_s);
    differs = differs || one[i].delta.port != other[i].delta.port;
  }
  EXPECT_TRUE(differs);
}

TEST(Manoeuvres, ScheduleStartsEachCommandWhenTheLastOneEnds) {
  const auto commands = Schedule({Coast(2.0), SurgeSteps(0.1, 0.9, 1, 3.0), Coast(1.0)}, 100.0);
  const double expected[] = {100.0, 102.0, 105.0, 108.0};
  ASSERT_EQ(commands.size(), std::size(expected));
  for (std::size_t i = 0; i < commands.size(); ++i) EXPECT_EQ(commands[i].time_s, expected[i]);
  EXPECT_EQ(commands[2].delta.port, 0.9);
}

}  // namespace
}  // namespace telltale
