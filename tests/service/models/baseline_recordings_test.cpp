#include "telltale/service/models/baseline_recordings.hpp"

#include <gtest/gtest.h>

namespace telltale {
namespace {

Recording FixesEverySecond(int count) {
  Recording recording;
  for (int i = 0; i < count; ++i) recording.gnss.push_back({1.0 * i, 0.0, 0.0});
  return recording;
}

TEST(BaselineRecordings, KeepThatOfTheNewestRevision) {
  BaselineRecordings baseline;
  EXPECT_FALSE(baseline.Behind("boat", 1));
  baseline.Keep("boat", 1, FixesEverySecond(10));
  baseline.Keep("boat", 2, FixesEverySecond(100));
  EXPECT_FALSE(baseline.Behind("boat", 1));
  EXPECT_FALSE(baseline.Behind("another", 2));
  ASSERT_TRUE(baseline.Behind("boat", 2));
  EXPECT_EQ(baseline.Behind("boat", 2)->gnss.size(), 100u);
}

}  // namespace
}  // namespace telltale
