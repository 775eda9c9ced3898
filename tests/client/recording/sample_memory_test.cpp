#include "telltale/client/recording/sample_memory.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "telltale/core/data/samples.hpp"

namespace telltale {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

constexpr double kRoundingS = 1e-9;

double HeadingAt(double time_s) {
  return 90.0 + 10.0 * std::sin(time_s);
}

HeadingSample SampleAt(double time_s) {
  return {time_s, HeadingAt(time_s)};
}

/// Whether every sample is one that SampleAt gives, later than the one before by at most `most_s`.
void ExpectWholeSamplesWithin(const std::vector<HeadingSample>& samples, double most_s) {
  for (std::size_t i = 0; i < samples.size(); ++i) {
    ASSERT_EQ(samples[i].heading_deg, HeadingAt(samples[i].time_s));
    if (i == 0) continue;
    ASSERT_GT(samples[i].time_s, samples[i - 1].time_s);
    ASSERT_LE(samples[i].time_s - samples[i - 1].time_s, most_s + kRoundingS);
  }
}

TEST(SampleMemory, KeepsEverySampleThatFits) {
  SampleMemory memory(1000 * sizeof(HeadingSample));
  SampleSeries<HeadingSample> headings(memory);
  for (int i = 0; i < 1000; ++i) headings.Add(SampleAt(0.001 * i));
  EXPECT_EQ(headings.Samples().size(), 1000u);
  EXPECT_EQ(memory.Summary(), "");
}

TEST(SampleMemory, ThinsTheFastSourceByWholeSamplesAndNoOther) {
  constexpr std::size_t kMost = 100'000;
  SampleMemory memory(kMost);
  SampleSeries<HeadingSample> headings(memory);
  SampleSeries<GnssFix> fixes(memory);
  constexpr int kFixes = 600;  // two minutes at 5 Hz beside headings at 400 Hz
  for (int i = 0; i < 80 * kFixes; ++i) {
    const double time_s = i / 400.0;
    headings.Add(SampleAt(time_s));
    if (i % 80 == 0) fixes.Add({time_s, 45.0, 9.0});
  }
  EXPECT_EQ(fixes.Samples().size(), kFixes);
  const std::size_t bytes =
      headings.Samples().size() * sizeof(HeadingSample) + kFixes * sizeof(GnssFix);
  EXPECT_LE(bytes, kMost);
  EXPECT_THAT(memory.Summary(), StartsWith("thinned by whole samples to 25 Hz"));
  EXPECT_EQ(headings.Samples().size(), 120u * 25u);
  ExpectWholeSamplesWithin(headings.Samples(), 1.0 / 25.0 + 1.0 / 400.0);
}

TEST(SampleMemory, ThinsLaterSamplesToTheSameRate) {
  SampleMemory memory(1000 * sizeof(HeadingSample));
  SampleSeries<HeadingSample> first(memory);
  for (int i = 0; i < 1001; ++i) first.Add(SampleAt(i / 200.0));
  SampleSeries<HeadingSample> second(memory);
  for (int i = 0; i < 200; ++i) second.Add(SampleAt(i / 200.0));
  EXPECT_THAT(memory.Summary(), HasSubstr("to 100 Hz"));
  EXPECT_EQ(second.Samples().size(), 100u);
}

TEST(SampleMemory, KeepsASlowSourceWhoseTimesAreUneven) {
  SampleMemory memory(4000 * sizeof(HeadingSample));
  SampleSeries<HeadingSample> fast(memory);
  SampleSeries<HeadingSample> slow(memory);
  for (int i = 0; i < 1000; ++i) slow.Add(SampleAt(0.1 * i + (i % 2 == 0 ? 0.0 : 0.03)));
  for (int i = 0; i < 20'000; ++i) fast.Add(SampleAt(i / 200.0));
  EXPECT_THAT(memory.Summary(), HasSubstr("to 25 Hz"));
  EXPECT_EQ(slow.Samples().size(), 1000u);
}

TEST(SampleMemory, LetsGoFirstOfWhatIsOlderThanADay) {
  constexpr int kDayS = 86400;
  SampleMemory memory(3 * kDayS / 2 * sizeof(HeadingSample));
  SampleSeries<HeadingSample> headings(memory);
  for (int s = 0; s < 3 * kDayS; ++s) headings.Add(SampleAt(s));
  const auto& samples = headings.Samples();
  EXPECT_THAT(memory.Summary(), HasSubstr("more than a day older than the newest"));
  EXPECT_THAT(memory.Summary(), Not(HasSubstr("thinned")));
  EXPECT_LE(samples.front().time_s, 2.0 * kDayS);
  EXPECT_EQ(samples.back().time_s, 3.0 * kDayS - 1.0);
  ExpectWholeSamplesWithin(samples, 1.0);
}

TEST(SampleMemory, AWrongTimeMakesNothingOld) {
  SampleMemory memory(1000 * sizeof(HeadingSample));
  SampleSeries<HeadingSample> headings(memory);
  for (int i = 0; i < 1000; ++i) headings.Add(SampleAt(i / 20.0));
  headings.Add(SampleAt(1e9));  // the one that does not fit
  EXPECT_THAT(memory.Summary(), Not(HasSubstr("older")));
  EXPECT_EQ(headings.Samples().front().time_s, 0.0);
  EXPECT_EQ(headings.Samples().back().time_s, 1e9);
}

TEST(SampleMemory, HoldsItsBoundWhereTimesSayNothing) {
  constexpr std::size_t kMost = 1000 * sizeof(HeadingSample);
  SampleMemory memory(kMost);
  SampleSeries<HeadingSample> headings(memory);
  for (int i = 0; i < 100'000; ++i) headings.Add({std::nan(""), static_cast<double>(i)});
  EXPECT_LE(headings.Samples().size() * sizeof(HeadingSample), kMost);
  EXPECT_EQ(headings.Samples().back().heading_deg, 99'999.0);
  EXPECT_THAT(memory.Summary(), HasSubstr("the oldest"));
}

TEST(SampleMemory, FindsRoomInWhatASourceGaveBack) {
  SampleMemory memory(1000 * sizeof(HeadingSample));
  SampleSeries<HeadingSample> given_back(memory);
  SampleSeries<HeadingSample> kept(memory);
  for (int i = 0; i < 900; ++i) given_back.Add(SampleAt(i / 200.0));
  given_back.Clear();
  for (int i = 0; i < 700; ++i) kept.Add(SampleAt(i / 200.0));
  EXPECT_EQ(kept.Samples().size(), 700u);
  EXPECT_EQ(memory.Summary(), "");
}

}  // namespace
}  // namespace telltale
