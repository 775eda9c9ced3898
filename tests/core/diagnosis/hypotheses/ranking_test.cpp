#include "telltale/core/diagnosis/hypotheses/ranking.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "support/hand_made_diagnosis.hpp"

namespace telltale {
namespace {

constexpr double kNoEvidence = 0.0;
constexpr double kStrongEvidence = -50.0;
const LackOfFit kLikeNominal{.before = 1.0, .after = 0.95, .nominal = 0.95};

TEST(GapAssessment, IsWithinNominalOnlyIfTheUpperBoundIs) {
  EXPECT_EQ(AssessGap(1.0, 1.3, 1.5, kNoEvidence, kLikeNominal), GapAssessment::kWithinNominal);
  // As small, but of a recording so short that the upper bound is far larger.
  EXPECT_EQ(AssessGap(1.0, 9.0, 1.5, kNoEvidence, kLikeNominal), GapAssessment::kUndecided);
  // Larger than the limit, without evidence for any effect.
  EXPECT_EQ(AssessGap(2.0, 2.2, 1.5, kNoEvidence, kLikeNominal), GapAssessment::kUndecided);
}

TEST(GapAssessment, IsMaterialForHighScoreOrLargeLackOfFit) {
  EXPECT_EQ(AssessGap(1.0, 1.3, 1.5, kStrongEvidence, kLikeNominal), GapAssessment::kMaterial);
  const LackOfFit large{.before = 4.0, .after = 3.9, .nominal = 0.95};
  EXPECT_EQ(AssessGap(1.0, 1.3, 1.5, kNoEvidence, large), GapAssessment::kMaterial);
}

TEST(Verdict, FollowsAssessmentProbabilityAndExcessExplained) {
  Ranking ranking;
  ranking.fits.emplace_back().probability = 0.95;
  const ExcessExplained most{.share = 0.9, .interval = {}};
  const ExcessExplained half{.share = 0.5, .interval = {}};
  EXPECT_EQ(VerdictOf(GapAssessment::kWithinNominal, ranking, most), Verdict::kNoMaterialGap);
  EXPECT_EQ(VerdictOf(GapAssessment::kUndecided, ranking, most), Verdict::kInsufficientData);
  EXPECT_EQ(VerdictOf(GapAssessment::kMaterial, ranking, most), Verdict::kExplained);
  EXPECT_EQ(VerdictOf(GapAssessment::kMaterial, ranking, half), Verdict::kPartlyExplained);
  // More probable than all else together, but by less than nine to one.
  ranking.fits.front().probability = 0.85;
  EXPECT_EQ(VerdictOf(GapAssessment::kMaterial, ranking, most), Verdict::kUnknownCause);
}

TEST(IsLikely, HoldsForTheMostProbableCauseOfAMaterialGap) {
  Ranking ranking;
  EXPECT_FALSE(IsLikely(GapAssessment::kMaterial, ranking));
  ranking.fits.resize(2);
  ranking.fits[0].probability = 0.4;
  ranking.fits[1].probability = 0.3;
  ranking.unknown = 0.3;
  EXPECT_TRUE(IsLikely(GapAssessment::kMaterial, ranking));
  EXPECT_FALSE(IsLikely(GapAssessment::kUndecided, ranking));
  ranking.unknown = 0.45;
  EXPECT_FALSE(IsLikely(GapAssessment::kMaterial, ranking));
  ranking.unknown = 0.2;
  ranking.fits[1].probability = 0.5;
  EXPECT_FALSE(IsLikely(GapAssessment::kMaterial, ranking));
}

/// An effect at its typical size, with shapes at their prior means.
ModelledEffect AtPriorMean(const char* name) {
  ModelledEffect modelled{FindEffect(name), {}};
  for (const EffectParameter& parameter : modelled.effect->Parameters()) {
    modelled.values.push_back(parameter.is_shape ? parameter.prior_mean : parameter.typical);
  }
  return modelled;
}

struct RankedBoat : testing::LearnedBaseline {
  ResidualMetric metric{nominal, recording, EveryWindow(recording), false};

  EffectFit Scored(const char* effect, double score) const {
    EffectFit fit;
    fit.effects = {AtPriorMean(effect)};
    fit.score = score;
    fit.errors = recording.errors;
    fit.square = metric.SquaredMahalanobis(metric.Whiten(fit.errors));
    return fit;
  }
};

// Two hypotheses that predict the same are one class with the probability of both. A stochastic
// effect predicts no path and is in no class with them.
TEST(Rank, MergesHypothesesThatPredictTheSame) {
  const RankedBoat boat;
  Hypotheses hypotheses;
  hypotheses.singles = {boat.Scored("thruster_lag", -40.0), boat.Scored("thruster_delay", -38.0),
                        boat.Scored("waves", -36.0)};
  const Ranking ranking = Rank(hypotheses, boat.metric, kLikeNominal);
  ASSERT_EQ(ranking.fits.size(), 2U);
  EXPECT_EQ(ranking.fits[0].Indistinguishable(), std::vector<std::string>{"thruster_delay"});
  EXPECT_EQ(ranking.fits[1].fit.Names(), std::vector<std::string>{"waves"});
  double sum = ranking.no_effect + ranking.unknown;
  for (const RankedHypothesis& ranked : ranking.fits) sum += ranked.probability;
  EXPECT_NEAR(sum, 1.0, 1e-12);
}

TEST(Rank, UnknownProbabilityGrowsWithLackOfFit) {
  const RankedBoat boat;
  Hypotheses hypotheses;
  hypotheses.singles = {boat.Scored("thruster_lag", -40.0)};
  double lower_unknown_probability = -1.0;
  for (const double after : {0.9, 1.5, 3.0, 8.0, 20.0}) {
    const Ranking ranking = Rank(hypotheses, boat.metric,
                                 {.before = 20.0, .after = after, .nominal = 1.0, .median = after});
    EXPECT_GT(ranking.unknown, lower_unknown_probability) << after;
    lower_unknown_probability = ranking.unknown;
  }
  EXPECT_GT(lower_unknown_probability, 0.95);
}

// A few windows that err far more leave a fault's probability as it is where the others err as on
// nominal days, by three quarters of the mean square: the library knows the course of a spell or of
// a step roughly.
TEST(Rank, UnknownProbabilityOfFaultsGoesByTheMedianWindow) {
  const RankedBoat boat;
  Hypotheses hypotheses;
  hypotheses.singles = {boat.Scored("thruster_lag", -40.0)};
  const auto doubt = [&](double median) {
    return Rank(hypotheses, boat.metric,
                {.before = 30.0, .after = 5.0, .nominal = 1.0, .median = median})
        .unknown;
  };
  EXPECT_LT(doubt(0.75), 0.2);
  EXPECT_GT(doubt(5.0), 0.8);
}

// The report says why.
TEST(Rank, UnknownProbabilityIsThatOfItsTerms) {
  const RankedBoat boat;
  Hypotheses hypotheses;
  hypotheses.singles = {boat.Scored("current", -40.0)};
  const Ranking ranking =
      Rank(hypotheses, boat.metric,
           {.before = 20.0, .after = 2.0, .nominal = 1.0, .median = 1.5, .predictable = 0.25});
  double log_odds = 0.0;
  for (const OddsTerm& term : ranking.unknown_odds) log_odds += term.log_odds;
  EXPECT_NEAR(std::log(ranking.unknown / (1.0 - ranking.unknown)), log_odds, 1e-9);
  const auto predictable = std::ranges::find(ranking.unknown_odds, "predictable", &OddsTerm::name);
  ASSERT_NE(predictable, ranking.unknown_odds.end());
  EXPECT_EQ(predictable->value, 0.25);
  EXPECT_GT(predictable->log_odds, 0.0);
}

// With little evidence, what another cause would leave is not resolved.
TEST(Rank, UnknownProbabilityGrowsWithWeakEvidence) {
  const RankedBoat boat;
  const auto doubt = [&](double score) {
    Hypotheses hypotheses;
    hypotheses.singles = {boat.Scored("thruster_lag", score)};
    const LackOfFit closed{.before = 2.0, .after = 1.0, .nominal = 1.0, .median = 0.8};
    return Rank(hypotheses, boat.metric, closed).unknown;
  };
  EXPECT_GT(doubt(-10.0), doubt(-20.0));
  EXPECT_GT(doubt(-20.0), doubt(-100.0));
  EXPECT_LT(doubt(-100.0), 0.05);
}

// Two faults imitate one that the library lacks more easily than one does. Weather beside a fault
// is no fault.
TEST(Rank, UnknownProbabilityGrowsWithFurtherFaults) {
  const RankedBoat boat;
  const auto doubt = [&](const std::vector<const char*>& beside) {
    Hypotheses hypotheses;
    hypotheses.singles = {boat.Scored("thruster_lag", -40.0)};
    for (const char* effect : beside) {
      hypotheses.singles.front().effects.push_back(AtPriorMean(effect));
    }
    const LackOfFit lack_of_fit{.before = 20.0, .after = 1.0, .nominal = 1.0, .median = 0.8};
    return Rank(hypotheses, boat.metric, lack_of_fit).unknown;
  };
  EXPECT_EQ(doubt({"wind"}), doubt({}));
  EXPECT_GT(doubt({"thrust_gain"}), doubt({}));
  EXPECT_GT(doubt({"thrust_gain", "heading_bias"}), doubt({"thrust_gain"}));
}

// What a hypothesis allows for beside a fault, a current that drifts, waves or spells, hides what
// else there is. A thrust gain allows for nothing.
TEST(Rank, UnknownProbabilityGrowsWithWhatIsAllowedFor) {
  const RankedBoat boat;
  const auto doubt = [&](const char* beside) {
    Hypotheses hypotheses;
    hypotheses.singles = {boat.Scored("thruster_lag", -40.0)};
    hypotheses.singles.front().effects.push_back(AtPriorMean(beside));
    const LackOfFit lack_of_fit{.before = 20.0, .after = 1.0, .nominal = 1.0, .median = 0.8};
    return Rank(hypotheses, boat.metric, lack_of_fit).unknown;
  };
  for (const char* beside : {"current", "waves", "intermittent_thrust_loss"}) {
    EXPECT_GT(doubt(beside), doubt("thrust_gain")) << beside;
  }
  EXPECT_EQ(doubt("heading_bias"), doubt("thrust_gain"));
}

// A current or waves alone leave room for another cause that wind alone does not.
TEST(Rank, UnknownProbabilityOfWeatherGrowsWithWhatIsAllowedFor) {
  const RankedBoat boat;
  const auto doubt = [&](const char* weather) {
    Hypotheses hypotheses;
    hypotheses.singles = {boat.Scored(weather, -40.0)};
    const LackOfFit lack_of_fit{.before = 20.0, .after = 1.5, .nominal = 1.0, .median = 0.8};
    return Rank(hypotheses, boat.metric, lack_of_fit).unknown;
  };
  EXPECT_GT(doubt("current"), doubt("wind"));
  EXPECT_GT(doubt("waves"), doubt("wind"));
}

// What is predictable in the errors is something that the hypothesis lacks. Negative values do not
// count in its favour.
TEST(Rank, UnknownProbabilityGrowsWithPredictableResiduals) {
  const RankedBoat boat;
  Hypotheses hypotheses;
  hypotheses.singles = {boat.Scored("thruster_lag", -40.0)};
  const auto doubt = [&](double predictable) {
    const LackOfFit lack_of_fit{
        .before = 20.0, .after = 2.0, .nominal = 1.0, .predictable = predictable};
    return Rank(hypotheses, boat.metric, lack_of_fit).unknown;
  };
  EXPECT_GT(doubt(0.3), doubt(0.0));
  EXPECT_EQ(doubt(-0.3), doubt(0.0));
}

// The place of a payload is a shape parameter and counts; its mass is a size and does not.
TEST(Rank, UnknownProbabilityGrowsWithTheNegativeLogPrior) {
  const RankedBoat boat;
  const auto doubt = [&](double mass_gain, double forward_m) {
    Hypotheses hypotheses;
    hypotheses.singles = {boat.Scored("payload", -40.0)};
    hypotheses.singles.front().effects.front().values = {mass_gain, forward_m};
    const LackOfFit lack_of_fit{.before = 20.0, .after = 2.0, .nominal = 1.0};
    return Rank(hypotheses, boat.metric, lack_of_fit).unknown;
  };
  EXPECT_GT(doubt(0.2, 0.3), doubt(0.2, 0.0));
  EXPECT_GT(doubt(0.2, -0.6), doubt(0.2, 0.3));
  EXPECT_EQ(doubt(0.4, 0.3), doubt(0.2, 0.3));
}

}  // namespace
}  // namespace telltale
