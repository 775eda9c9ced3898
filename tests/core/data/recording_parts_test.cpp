#include "telltale/core/data/recording_parts.hpp"

#include <vector>

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

Recording Commanded(const std::vector<double>& port_us) {
  Recording recording;
  for (std::size_t i = 0; i < port_us.size(); ++i) {
    recording.thrusters.push_back({1.0 * static_cast<double>(i), port_us[i], 1500.0});
  }
  return recording;
}

TEST(Liveliest, IsWhereTheCommandsChangeTheMost) {
  const Recording part =
      Liveliest(Commanded({1500, 1600, 1600, 1600, 1500, 1700, 1500, 1500, 1500, 1700}), 3.0);
  ASSERT_EQ(part.thrusters.size(), 3u);
  EXPECT_EQ(part.thrusters.back().time_s, 6.0);
}

TEST(Liveliest, IsTheStartWhereNothingChanges) {
  EXPECT_EQ(Liveliest(Commanded(std::vector<double>(10, 1500.0)), 3.0).thrusters.back().time_s,
            3.0);
}

TEST(Liveliest, IsTheWholeWhereItIsNoLonger) {
  EXPECT_EQ(Liveliest(Commanded({1500, 1600, 1700}), 2.0).thrusters.size(), 3u);
  EXPECT_EQ(Liveliest(EverySecond(), 10.0).gnss.size(), 101u);  // no commands
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
