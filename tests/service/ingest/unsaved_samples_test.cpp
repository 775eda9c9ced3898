#include "telltale/service/ingest/unsaved_samples.hpp"

#include <gtest/gtest.h>

namespace telltale {
namespace {

TEST(UnsavedSamples, GivesWhatCameInItsOrderOnce) {
  UnsavedSamples unsaved(1 << 20);
  unsaved.Add(GnssFix{1.0, 37.0, -6.0});
  unsaved.Add(HeadingSample{1.1, 10.0});
  unsaved.Add(HeadingSample{1.2, 11.0});
  unsaved.Add(ThrusterSample{1.3, 1600.0, 1500.0});
  EXPECT_EQ(unsaved.size(), 4u);
  const Recording samples = unsaved.Take();
  EXPECT_EQ(samples.gnss.size(), 1u);
  ASSERT_EQ(samples.heading.size(), 2u);
  EXPECT_EQ(samples.heading[1].time_s, 1.2);
  EXPECT_EQ(samples.thrusters.size(), 1u);
  EXPECT_EQ(unsaved.size(), 0u);
  EXPECT_EQ(unsaved.dropped(), 0u);
}

TEST(UnsavedSamples, KeepsTheNewestWithinItsMemoryAndCountsTheOthers) {
  constexpr std::size_t kMost = 800;
  constexpr std::size_t kCame = 100'000;
  UnsavedSamples unsaved(kMost * sizeof(HeadingSample));
  for (std::size_t i = 0; i < kCame; ++i) {
    unsaved.Add(HeadingSample{static_cast<double>(i), 10.0});
    ASSERT_LE(unsaved.size(), kMost);
  }
  EXPECT_GE(unsaved.size(), kMost * 7 / 8 - 1);
  EXPECT_EQ(unsaved.size() + unsaved.dropped(), kCame);
  const Recording samples = unsaved.Take();
  for (std::size_t i = 0; i < samples.heading.size(); ++i) {
    ASSERT_EQ(samples.heading[i].time_s, static_cast<double>(kCame - samples.heading.size() + i));
  }
}

TEST(UnsavedSamples, DropsOfEachChannel) {
  UnsavedSamples unsaved(1 << 20);
  for (int i = 0; i < 800; ++i) {
    unsaved.Add(HeadingSample{0.1 * i, 10.0});
    if (i % 10 == 0) unsaved.Add(GnssFix{0.1 * i, 37.0, -6.0});
  }
  unsaved.LimitMemory(400 * sizeof(HeadingSample) + 40 * sizeof(GnssFix));
  const Recording samples = unsaved.Take();
  EXPECT_GT(samples.gnss.front().time_s, 40.0);
  EXPECT_NEAR(samples.gnss.front().time_s, samples.heading.front().time_s, 2.0);
  EXPECT_EQ(samples.heading.back().time_s, 0.1 * 799);
}

}  // namespace
}  // namespace telltale
