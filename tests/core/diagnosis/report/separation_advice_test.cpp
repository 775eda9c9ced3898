#include "telltale/core/diagnosis/report/separation_advice.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/hand_made_diagnosis.hpp"

namespace telltale {
namespace {

SeparationAdvice AdviceOf(const char* manoeuvre, double nats) {
  SeparationAdvice advice;
  advice.manoeuvre = manoeuvre;
  advice.expected_nats = nats;
  return advice;
}

TEST(MostSeparating, ListsAtMostThreeMostNatsFirst) {
  const auto most = MostSeparating({AdviceOf("a", 2.0), AdviceOf("b", 9.0), AdviceOf("c", 3.0),
                                    AdviceOf("d", 4.0), AdviceOf("e", 0.9)});
  ASSERT_EQ(most.size(), 3U);
  EXPECT_EQ(most[0].manoeuvre, "b");
  EXPECT_EQ(most[1].manoeuvre, "d");
  EXPECT_EQ(most[2].manoeuvre, "c");
}

TEST(MostSeparating, LeavesOutLessThanOneNat) {
  EXPECT_THAT(MostSeparating({AdviceOf("a", 0.99)}), ::testing::IsEmpty());
  EXPECT_THAT(MostSeparating({AdviceOf("a", 1.0)}), ::testing::SizeIs(1));
}

EffectFit FitOfEffect(const char* effect, std::vector<double> values) {
  EffectFit fit;
  fit.effects = {{FindEffect(effect), std::move(values)}};
  return fit;
}

/// A baseline of free runs of five seconds, ten bins of three errors of 5 cm or 0.05 rad.
NominalBaseline FiveCentimetres() {
  NominalBaseline nominal = testing::UnitBaseline(30, 0, 0);
  nominal.covariance *= 0.05 * 0.05;
  return nominal;
}

TEST(SeparatingManoeuvres, AreNoneWithoutEquivalents) {
  const RankedHypothesis alone{FitOfEffect("thrust_gain", {0.3}), 1.0, {}};
  EXPECT_TRUE(AdviseSeparatingManoeuvres(alone, FiveCentimetres(), 0.2, {}).empty());
}

TEST(SeparatingManoeuvres, AreNoneBetweenEqualPredictions) {
  const EffectFit gain = FitOfEffect("thrust_gain", {0.3});
  EXPECT_TRUE(AdviseSeparatingManoeuvres({gain, 1.0, {gain}}, FiveCentimetres(), 0.2, {}).empty());
}

TEST(SeparatingManoeuvres, NameBothEffectsAndAreDecisiveAboveFiveNats) {
  const RankedHypothesis tied{
      FitOfEffect("thrust_gain", {0.3}), 1.0, {FitOfEffect("heading_bias", {0.2})}};
  const auto advice = AdviseSeparatingManoeuvres(tied, FiveCentimetres(), 0.2, {});
  ASSERT_FALSE(advice.empty());
  EXPECT_EQ(advice[0].separates, (std::vector<std::string>{"thrust_gain", "heading_bias"}));
  for (const SeparationAdvice& one : advice) EXPECT_EQ(one.decisive, one.expected_nats > 5.0);
  EXPECT_TRUE(advice[0].decisive);
}

}  // namespace
}  // namespace telltale
