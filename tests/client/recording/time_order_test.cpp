#include "telltale/client/recording/time_order.hpp"
#include "support/special_values.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace telltale {
namespace {

using testing::ElementsAre;

std::vector<GnssFix> Gnss(std::initializer_list<double> times) {
  std::vector<GnssFix> samples;
  for (const double t : times) samples.push_back({t, 0.0, 0.0});
  return samples;
}

std::vector<HeadingSample> Heading(std::initializer_list<double> times) {
  std::vector<HeadingSample> samples;
  for (const double t : times) samples.push_back({t, 0.0});
  return samples;
}

std::vector<ThrusterSample> Thrusters(std::initializer_list<double> times) {
  std::vector<ThrusterSample> samples;
  for (const double t : times) samples.push_back({t, 1500.0, 1500.0});
  return samples;
}

std::vector<double> Times(const std::vector<RawSample>& samples) {
  std::vector<double> times;
  for (const RawSample& sample : samples) times.push_back(TimeOf(sample));
  return times;
}

TEST(InOrderOfTime, WeavesTheChannels) {
  EXPECT_THAT(Times(InOrderOfTime({Gnss({0, 3, 6}), Heading({1, 4, 7}), Thrusters({2, 5, 8})})),
              ElementsAre(0, 1, 2, 3, 4, 5, 6, 7, 8));
}

TEST(InOrderOfTime, AnEmptyChannelIsNoObstacle) {
  EXPECT_THAT(Times(InOrderOfTime({{}, Heading({1, 2}), {}})), ElementsAre(1, 2));
  EXPECT_TRUE(InOrderOfTime({}).empty());
}

TEST(InOrderOfTime, SamplesOfOneChannelKeepTheirOrder) {
  EXPECT_THAT(Times(InOrderOfTime({Gnss({0, 2, 1, 3}), {}, {}})), ElementsAre(0, 2, 1, 3));
}

TEST(InOrderOfTime, AWrongTimeDoesNotHoldItsChannelBack) {
  const auto times =
      Times(InOrderOfTime({Gnss({0, 2, 1e9, 6, 8, 10}), Heading({1, 3, 5, 7, 9}), {}}));
  EXPECT_LT(std::find(times.begin(), times.end(), 1e9), std::find(times.begin(), times.end(), 7));
  EXPECT_LT(std::find(times.begin(), times.end(), 6), std::find(times.begin(), times.end(), 7));
  EXPECT_EQ(times.size(), 11u);
}

TEST(InOrderOfTime, AMissingTimeStaysBetweenItsNeighbours) {
  const auto ordered = InOrderOfTime({Gnss({0, 2, kNan, 6}), Heading({1, 3, 5, 7}), {}});
  ASSERT_EQ(ordered.size(), 8u);
  EXPECT_DOUBLE_EQ(TimeOf(ordered.back()), 7.0);
}

TEST(InOrderOfTime, AClockSetBackBeginsANewEpochInEveryChannel) {
  const auto times = Times(InOrderOfTime({Gnss({1000, 1002, 1004, 1006, 10, 12, 14, 16}),
                                          Heading({1001, 1003, 1005, 1007, 11, 13, 15, 17}),
                                          {}}));
  EXPECT_THAT(times, ElementsAre(1000, 1001, 1002, 1003, 1004, 1005, 1006, 1007, 10, 11, 12, 13, 14,
                                 15, 16, 17));
}

}  // namespace
}  // namespace telltale
