#include "telltale/core/diagnosis/delays/delay_difference.hpp"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "telltale/core/diagnosis/diagnosis_constants.hpp"

namespace telltale {
namespace {

using enum DelayedChannel;

constexpr double kErrorS = 0.03;

/// Days whose delays scatter about 0.1 s, each known to kErrorS.
class Days {
 public:
  explicit Days(std::uint64_t seed) : random_(seed) {}

  /// Scatter between days as the prior expects it.
  void DrawScatter() { between_s_ = std::abs(kDiagnosis.delays.between_days_sd_s * Normal()); }

  DelayEstimate Next(double fault_s = 0.0) {
    return {0.1 + fault_s + between_s_ * Normal() + kErrorS * Normal(), kErrorS};
  }

  std::vector<DelayEstimate> Several(int count) {
    std::vector<DelayEstimate> days;
    for (int i = 0; i < count; ++i) days.push_back(Next());
    return days;
  }

 private:
  double Normal() { return normal_(random_); }

  std::mt19937_64 random_;
  std::normal_distribution<double> normal_;
  double between_s_ = 0.0;
};

TEST(DelayDifference, HoldsNominalDaysWithinItsStandardDeviation) {
  constexpr int kTrials = 2000;
  Days days(1);
  int within = 0;
  int late = 0;
  for (int i = 0; i < kTrials; ++i) {
    days.DrawScatter();
    const DelayDifference difference = DelayDifferenceOf(kFixes, days.Next(), days.Several(4));
    within += std::abs(difference.difference_s) < 1.96 * difference.standard_deviation_s;
    late += IsLate(difference);
  }
  // Of 2000, 95 % are 1900 with a binomial standard deviation of 9.7; three of those either way.
  EXPECT_NEAR(within, 1900, 29);
  // Odds of e^4 to one at even prior odds hold for at most one nominal day in e^4 + 1 (Markov).
  EXPECT_LE(late, kTrials / 55);
}

TEST(DelayDifference, IsTheDifferenceToTheMeanOfDaysThatAreKnownAlike) {
  const DelayDifference difference =
      DelayDifferenceOf(kCommands, {0.5, 0.02}, {{0.1, 0.02}, {0.12, 0.02}, {0.14, 0.02}});
  EXPECT_EQ(difference.channel, kCommands);
  EXPECT_NEAR(difference.difference_s, 0.38, 1e-9);  // by symmetry, whatever the scatter
  EXPECT_TRUE(IsLate(difference));
}

TEST(DelayDifference, SpeaksForANominalDayWhereTheDelaysAgree) {
  const DelayDifference difference =
      DelayDifferenceOf(kFixes, {0.1, 0.02}, {{0.1, 0.02}, {0.1, 0.02}});
  EXPECT_GT(difference.score, 0.0);  // a delay that may be anything is less likely
  EXPECT_FALSE(IsLate(difference));
}

TEST(DelayDifference, CallsNoChannelLateThatIsEarly) {
  const DelayDifference difference =
      DelayDifferenceOf(kFixes, {-0.5, 0.02}, {{0.1, 0.02}, {0.1, 0.02}});
  EXPECT_LT(difference.score, -kDiagnosis.ranking.material_score);
  EXPECT_FALSE(IsLate(difference));
}

TEST(DelayDifference, IsWiderWhereReferencesScatter) {
  const DelayEstimate recording{0.2, 0.01};
  const DelayDifference alike =
      DelayDifferenceOf(kFixes, recording, {{0.1, 0.01}, {0.1, 0.01}, {0.1, 0.01}});
  const DelayDifference apart =
      DelayDifferenceOf(kFixes, recording, {{0.05, 0.01}, {0.1, 0.01}, {0.15, 0.01}});
  EXPECT_GT(apart.standard_deviation_s, 1.5 * alike.standard_deviation_s);
  EXPECT_GT(apart.score, alike.score);
}

TEST(DelayDifference, StatesTheFaultThatShowsInNineCasesOfTen) {
  constexpr int kTrials = 2000;
  Days days(2);
  int shown = 0;
  for (int i = 0; i < kTrials; ++i) {
    days.DrawScatter();
    const std::vector<DelayEstimate> nominal = days.Several(4);
    const auto detectable_s = DelayDifferenceOf(kFixes, {0.1, kErrorS}, nominal).detectable_s;
    ASSERT_TRUE(detectable_s.has_value());
    shown += IsLate(DelayDifferenceOf(kFixes, days.Next(*detectable_s), nominal));
  }
  // Three binomial standard deviations are 2 %; one more, as the law is a normal one of the same
  // variance as the mixture.
  EXPECT_NEAR(static_cast<double>(shown) / kTrials, 0.9, 0.03);
}

TEST(DelayDifference, StatesNoFaultBeyondTheRangeOfItsEffect) {
  EXPECT_FALSE(DelayDifferenceOf(kFixes, {0.1, 1.0}, {{0.1, 0.02}, {0.1, 0.02}}).detectable_s);
}

TEST(DelayDifferences, TakeTheReferencesThatShowTheirDelays) {
  const RecordingDelays early = {{{0.0, 0.02}, {0.0, 0.02}}};
  const RecordingDelays late = {{{0.3, 0.02}, {0.0, 0.02}}};
  const ComparedDelays delays{late, {early, std::nullopt, early, late}};
  const auto all = DelayDifferencesOf(delays);
  ASSERT_EQ(all.size(), kDelayedChannels.size());
  const auto without_the_late_one = DelayDifferencesOf(delays, 3);
  EXPECT_LT(all[0].difference_s, without_the_late_one[0].difference_s);
  EXPECT_NEAR(without_the_late_one[0].difference_s, 0.3, 1e-9);
  EXPECT_NEAR(without_the_late_one[1].difference_s, 0.0, 1e-9);
}

TEST(DelayDifferences, NeedTheRecordingAndTwoReferences) {
  const RecordingDelays own{};
  EXPECT_TRUE(DelayDifferencesOf({std::nullopt, {own, own}}).empty());
  EXPECT_TRUE(DelayDifferencesOf({own, {own, std::nullopt}}).empty());
  EXPECT_TRUE(DelayDifferencesOf({own, {own, own}}, 0).empty());
}

}  // namespace
}  // namespace telltale
