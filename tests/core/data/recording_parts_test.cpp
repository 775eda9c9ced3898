#include "telltale/core/data/recording_parts.hpp"

#include <gtest/gtest.h>

namespace telltale {
namespace {

Recording EverySecond() {
  Recording recording;
  for (int i = 0; i <= 100; ++i) {
    recording.gnss.push_back({1.0 * i, 0.0, 0.0});
    recording.heading.push_back({i + 0.5, 0.0});
  }
  recording.rejected.Count(Channel::kGnss, RejectReason::kDuplicate);
  return recording;
}

TEST(EndTime, IsThatOfTheNewestSampleOfAnyChannel) {
  EXPECT_EQ(EndTime(EverySecond()), 100.5);
  EXPECT_EQ(EndTime(Recording()), 0.0);
}

TEST(Between, ExcludesItsStartAndIncludesItsEnd) {
  const Recording part = Between(EverySecond(), 10.0, 20.0);
  EXPECT_EQ(part.gnss.front().time_s, 11.0);
  EXPECT_EQ(part.gnss.back().time_s, 20.0);
  EXPECT_EQ(part.heading.size(), 10u);
  EXPECT_TRUE(part.thrusters.empty());
  EXPECT_EQ(part.rejected.Total(), 1u);
}

TEST(Between, IsEmptyWhereTheEndPrecedesTheStart) {
  EXPECT_TRUE(Between(EverySecond(), 20.0, 10.0).gnss.empty());
}

TEST(Between, HoldsTheRecordingsThatBeginThere) {
  Recording recording = EverySecond();
  recording.starts_s = {0.0, 10.0, 15.0, 20.0, 60.0};
  EXPECT_EQ(Between(recording, 10.0, 20.0).starts_s, (std::vector<double>{15.0, 20.0}));
}

TEST(Latest, HoldsTheLastMinute) {
  Recording recording;
  for (int i = 0; i <= 100; ++i) recording.gnss.push_back({1.0 * i, 0.0, 0.0});
  EXPECT_EQ(Latest(recording, 60.0).gnss.front().time_s, 40.0);
  EXPECT_EQ(Latest(recording, 600.0).gnss.size(), 101u);
  EXPECT_TRUE(Latest(Recording(), 60.0).gnss.empty());
}

}  // namespace
}  // namespace telltale
