#include "telltale/core/data/recording_starts.hpp"

#include <gtest/gtest.h>

namespace telltale {
namespace {

Recording HeardAt(const std::vector<double>& gnss_s, const std::vector<double>& thrusters_s) {
  Recording recording;
  for (const double time_s : gnss_s) recording.gnss.push_back({time_s, 37.0, -6.0});
  for (const double time_s : thrusters_s) recording.thrusters.push_back({time_s, 1500.0, 1500.0});
  return recording;
}

TEST(StartsAfterSilence, PartWhereEveryChannelIsSilent) {
  const Recording recording = HeardAt({10.0, 11.0, 200.0, 201.0}, {10.5, 11.5, 199.5, 300.0});
  EXPECT_EQ(StartsAfterSilence(recording, 60.0), (std::vector<double>{10.0, 199.5, 300.0}));
}

TEST(StartsAfterSilence, OneActiveChannelKeepsARecordingWhole) {
  const Recording recording = HeardAt({0.0, 100.0}, {50.0});
  EXPECT_EQ(StartsAfterSilence(recording, 60.0), std::vector<double>{0.0});
  EXPECT_EQ(StartsAfterSilence(recording, 49.0), (std::vector<double>{0.0, 50.0, 100.0}));
}

TEST(StartsAfterSilence, AnEmptyRecordingHasNoStart) {
  EXPECT_TRUE(StartsAfterSilence({}, 60.0).empty());
}

}  // namespace
}  // namespace telltale
