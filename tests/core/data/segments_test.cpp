#include "telltale/core/data/segments.hpp"

#include <gtest/gtest.h>

namespace telltale {
namespace {

Recording Regular(double from, double to) {
  Recording recording;
  for (int i = 0; from + 0.2 * i <= to; ++i) recording.gnss.push_back({from + 0.2 * i, 0, 0});
  for (int i = 0; from + 0.1 * i <= to; ++i) recording.heading.push_back({from + 0.1 * i, 0});
  for (int i = 0; from + 0.1 * i <= to; ++i) recording.thrusters.push_back({from + 0.1 * i, 0, 0});
  return recording;
}

TEST(FindSegments, FindsOneWithoutGaps) {
  const auto segments = FindSegments(Regular(5.0, 25.05), 1.0);
  ASSERT_EQ(segments.size(), 1u);
  EXPECT_DOUBLE_EQ(segments[0].start_s, 5.0);
  EXPECT_NEAR(segments[0].end_s, 25.0, 1e-9);
}

TEST(FindSegments, FindsThemWhereAllThreeChannelsHaveSamples) {
  Recording recording = Regular(0.0, 30.0);
  std::erase_if(recording.heading, [](const auto& s) { return s.time_s < 4.95; });
  std::erase_if(recording.thrusters, [](const auto& s) { return s.time_s > 20.05; });
  const auto segments = FindSegments(recording, 1.0);
  ASSERT_EQ(segments.size(), 1u);
  EXPECT_NEAR(segments[0].start_s, 5.0, 1e-9);
  EXPECT_NEAR(segments[0].end_s, 20.0, 1e-9);
}

TEST(FindSegments, KeepsASegmentOverASilenceOfExactlyTheLimit) {
  Recording recording = Regular(0.0, 20.0);
  std::erase_if(recording.gnss, [](const auto& s) { return s.time_s > 5.1 && s.time_s < 5.9; });
  EXPECT_EQ(FindSegments(recording, 1.0).size(), 1u);
  EXPECT_EQ(FindSegments(recording, 0.9).size(), 2u);
}

TEST(FindSegments, KeepsSamplesOnTheirSideOfAGap) {
  Recording recording = Regular(0.0, 20.0);
  std::erase_if(recording.gnss, [](const auto& s) { return s.time_s > 8.1 && s.time_s < 11.9; });
  const auto segments = FindSegments(recording, 1.0);
  ASSERT_EQ(segments.size(), 2u);
  EXPECT_LT(recording.gnss[segments[0].Of(Channel::kGnss).end - 1].time_s, 8.1);
  EXPECT_GT(recording.gnss[segments[1].Of(Channel::kGnss).begin].time_s, 11.9);
  EXPECT_EQ(segments[1].Of(Channel::kHeading).begin, 0u) << "the heading had no gap";
}

TEST(FindSegments, FindsNoneWhereChannelsDoNotOverlap) {
  Recording recording = Regular(0.0, 10.0);
  recording.heading = Regular(20.0, 30.0).heading;
  EXPECT_TRUE(FindSegments(recording, 1.0).empty());
  recording.heading.clear();
  EXPECT_TRUE(FindSegments(recording, 1.0).empty());
}

}  // namespace
}  // namespace telltale
