#include "telltale/core/diagnosis/hypotheses/ranking.hpp"

#include <limits>

#include <gtest/gtest.h>

#include "support/stable_boat_with_effects.hpp"

namespace telltale {
namespace {

constexpr double kNoEvidence = 0.0;
constexpr double kStrongEvidence = -50.0;
const LackOfFit kLikeHealth{.before = 1.0, .after = 0.95, .nominal = 0.95};

TEST(GapAssessment, IsWithinNominalOnlyIfTheUpperBoundIs) {
  EXPECT_EQ(AssessGap(1.0, 1.3, 1.5, kNoEvidence, kLikeHealth), GapAssessment::kWithinNominal);
  // As small, but so short a recording that it could be far larger.
  EXPECT_EQ(AssessGap(1.0, 9.0, 1.5, kNoEvidence, kLikeHealth), GapAssessment::kUndecided);
  // Larger than nominal days, and nothing speaks for any effect.
  EXPECT_EQ(AssessGap(2.0, 2.2, 1.5, kNoEvidence, kLikeHealth), GapAssessment::kUndecided);
}

TEST(GapAssessment, IsMaterialForHighScoreOrLargeLackOfFit) {
  EXPECT_EQ(AssessGap(1.0, 1.3, 1.5, kStrongEvidence, kLikeHealth), GapAssessment::kMaterial);
  const LackOfFit wild{.before = 4.0, .after = 3.9, .nominal = 0.95};
  EXPECT_EQ(AssessGap(1.0, 1.3, 1.5, kNoEvidence, wild), GapAssessment::kMaterial);
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
  // Likelier than all else together, but not by nine to one.
  ranking.fits.front().probability = 0.85;
  EXPECT_EQ(VerdictOf(GapAssessment::kMaterial, ranking, most), Verdict::kUnknownCause);
}

TEST(Verdict, FollowsUpWhatIsLikelierThanNot) {
  Ranking ranking;
  EXPECT_FALSE(IsLikely(GapAssessment::kMaterial, ranking));
  ranking.fits.emplace_back();
  ranking.unknown = 0.4;
  EXPECT_TRUE(IsLikely(GapAssessment::kMaterial, ranking));
  EXPECT_FALSE(IsLikely(GapAssessment::kUndecided, ranking));
  ranking.unknown = 0.6;
  EXPECT_FALSE(IsLikely(GapAssessment::kMaterial, ranking));
}

/// At its typical size, shaped as usual.
ModelledEffect AtPriorMean(const char* name) {
  ModelledEffect modelled{FindEffect(name), {}};
  for (const EffectParameter& parameter : modelled.effect->Parameters()) {
    modelled.values.push_back(parameter.is_shape ? parameter.prior_mean : parameter.typical);
  }
  return modelled;
}

struct RankedBoat {
  UncertainModel model = UncertainModelOf(testing::KnownStableBoat()).value();
  std::vector<EffectParameterRef> parameter_refs = EffectParameterRefsOf(EffectLibrary());
  PreparedDataset sailed = testing::SimulateWithEffects({}, 120.0, 500);
  FreeRuns runs{sailed, model.model, 5.0};
  NominalBaseline nominal = LearnNominalBaseline({runs}, model, parameter_refs, 2);
  Sensitivity recording = SensitivityOf(runs, nominal.boat, model, parameter_refs, 2);
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

// Two explanations that predict the same are one class with the probability of both; one that only
// shakes predicts no path, and is none of theirs.
TEST(Rank, MergesHypothesesThatPredictTheSame) {
  const RankedBoat boat;
  Hypotheses hypotheses;
  hypotheses.singles = {boat.Scored("thruster_lag", -40.0), boat.Scored("thruster_delay", -38.0),
                        boat.Scored("waves", -36.0)};
  const Ranking ranking = Rank(hypotheses, boat.metric, kLikeHealth);
  ASSERT_EQ(ranking.fits.size(), 2U);
  EXPECT_EQ(ranking.fits[0].Indistinguishable(), std::vector<std::string>{"thruster_delay"});
  EXPECT_EQ(ranking.fits[1].fit.Names(), std::vector<std::string>{"waves"});
  double sum = ranking.no_effect + ranking.unknown;
  for (const RankedHypothesis& ranked : ranking.fits) sum += ranked.probability;
  EXPECT_NEAR(sum, 1.0, 1e-12);
}

// The more an explanation leaves, the likelier it is something else.
TEST(Rank, UnknownProbabilityGrowsWithLackOfFit) {
  const RankedBoat boat;
  Hypotheses hypotheses;
  hypotheses.singles = {boat.Scored("thruster_lag", -40.0)};
  double lower_unknown_probability = -1.0;
  for (const double after : {0.9, 1.5, 3.0, 8.0, 20.0}) {
    const Ranking ranking =
        Rank(hypotheses, boat.metric, {.before = 20.0, .after = after, .nominal = 1.0});
    EXPECT_GT(ranking.unknown, lower_unknown_probability) << after;
    lower_unknown_probability = ranking.unknown;
  }
  EXPECT_GT(lower_unknown_probability, 0.95);
}

// Where little speaks for an explanation, as little is missed of what another leaves.
TEST(Rank, UnknownProbabilityGrowsWithWeakEvidence) {
  const RankedBoat boat;
  const auto doubt = [&](double score) {
    Hypotheses hypotheses;
    hypotheses.singles = {boat.Scored("thruster_lag", score)};
    const LackOfFit closed{.before = 2.0, .after = 1.0, .nominal = 1.0};
    return Rank(hypotheses, boat.metric, closed).unknown;
  };
  EXPECT_GT(doubt(-10.0), doubt(-20.0));
  EXPECT_GT(doubt(-20.0), doubt(-100.0));
  EXPECT_LT(doubt(-100.0), 0.05);
}

// Two that mend between them what neither of them is are likelier to be mistaken than one.
TEST(Rank, UnknownProbabilityGrowsWithTheNumberOfEffects) {
  const RankedBoat boat;
  Hypotheses alone;
  alone.singles = {boat.Scored("thruster_lag", -40.0)};
  Hypotheses combined = alone;
  combined.combined = {boat.Scored("wind", -60.0)};
  combined.combined.front().effects.push_back(AtPriorMean("thruster_lag"));
  const LackOfFit lack_of_fit{.before = 20.0, .after = 2.0, .nominal = 1.0};
  EXPECT_GT(Rank(combined, boat.metric, lack_of_fit).unknown,
            Rank(alone, boat.metric, lack_of_fit).unknown);
}

// What could be learnt from the rest is something that the explanation lacks; that nothing can be
// learnt does not make it the likelier.
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

// A load as far forward as there is boat, or twice its mass, is as much of a load: only where it
// would have to be to explain what is seen makes it doubtful.
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

TEST(EffectFit, NegativeLogPriorCountsShapesInStandardDeviations) {
  EffectFit fit;
  fit.effects = {AtPriorMean("payload")};
  EXPECT_EQ(fit.NegativeLogPrior(), 0.0);
  const EffectParameter& forward = fit.effects.front().effect->Parameters()[1];
  fit.effects.front().values[1] = forward.prior_mean + 3.0 * forward.typical;
  EXPECT_NEAR(fit.NegativeLogPrior(), 4.5, 1e-12);
}

}  // namespace
}  // namespace telltale
