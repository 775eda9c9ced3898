#include "telltale/client/recording/due_times.hpp"

#include <cmath>
#include <initializer_list>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace telltale {
namespace {

using ::testing::ElementsAre;

std::vector<double> DueAt(std::initializer_list<double> times_s) {
  std::vector<RawSample> samples;
  for (const double time_s : times_s) samples.emplace_back(HeadingSample{time_s, 0.0});
  return DueTimes(samples);
}

TEST(DueTimes, FollowTheClockOfTheRecording) {
  EXPECT_THAT(DueAt({}), ElementsAre());
  EXPECT_THAT(DueAt({500.0, 501.0, 503.0}), ElementsAre(0.0, 1.0, 3.0));
}

TEST(DueTimes, ALateSampleIsDueAtOnce) {
  EXPECT_THAT(DueAt({0.0, 2.0, 1.0, 3.0}), ElementsAre(0.0, 2.0, 2.0, 3.0));
}

TEST(DueTimes, ALongSilenceIsCut) {
  EXPECT_THAT(DueAt({0.0, 7200.0, 7201.0}), ElementsAre(0.0, 60.0, 61.0));
}

TEST(DueTimes, AClockThatJumpsBackIsFollowed) {
  EXPECT_THAT(DueAt({1000.0, 1001.0, 0.0, 1.0, 3.0}), ElementsAre(0.0, 1.0, 1.0, 2.0, 4.0));
}

TEST(DueTimes, ASingleWrongTimeMovesNothing) {
  EXPECT_THAT(DueAt({0.0, 1.0, 1e9, 2.0, -1e9, 3.0}), ElementsAre(0.0, 1.0, 1.0, 2.0, 2.0, 3.0));
  EXPECT_THAT(DueAt({0.0, std::nan(""), 1.0}), ElementsAre(0.0, 0.0, 1.0));
  EXPECT_THAT(DueAt({std::nan(""), 5.0, 6.0}), ElementsAre(0.0, 0.0, 1.0));
}

}  // namespace
}  // namespace telltale
