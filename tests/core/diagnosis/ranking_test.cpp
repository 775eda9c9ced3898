#include "telltale/core/diagnosis/ranking.hpp"

#include <limits>

#include <gtest/gtest.h>

#include "support/augmented_boats.hpp"

namespace telltale {
namespace {

constexpr double kNoEvidence = 0.0;
constexpr double kStrongEvidence = -50.0;
const Remainder kLikeHealth{.before = 1.0, .after = 0.95, .healthy = 0.95};

TEST(Gate, ClosesOnlyWhereEvenTheUpperBoundIsHealthy) {
  EXPECT_EQ(GateOf(1.0, 1.3, 1.5, kNoEvidence, kLikeHealth), Gate::kWithinHealth);
  // As small, but so short a recording that it could be far larger.
  EXPECT_EQ(GateOf(1.0, 9.0, 1.5, kNoEvidence, kLikeHealth), Gate::kUndecided);
  // Larger than healthy days, and nothing speaks for any effect.
  EXPECT_EQ(GateOf(2.0, 2.2, 1.5, kNoEvidence, kLikeHealth), Gate::kUndecided);
}

TEST(Gate, OpensForEvidenceAndForWhatNoHealthyBoatLeaves) {
  EXPECT_EQ(GateOf(1.0, 1.3, 1.5, kStrongEvidence, kLikeHealth), Gate::kMaterial);
  const Remainder wild{.before = 4.0, .after = 3.9, .healthy = 0.95};
  EXPECT_EQ(GateOf(1.0, 1.3, 1.5, kNoEvidence, wild), Gate::kMaterial);
}

TEST(Verdict, FollowsGateDoubtAndClosure) {
  Ranking ranking;
  ranking.fits.emplace_back().probability = 0.95;
  const Closure most{.share = 0.9, .interval = {}};
  const Closure half{.share = 0.5, .interval = {}};
  EXPECT_EQ(VerdictOf(Gate::kWithinHealth, ranking, most), Verdict::kNoMaterialGap);
  EXPECT_EQ(VerdictOf(Gate::kUndecided, ranking, most), Verdict::kInsufficientData);
  EXPECT_EQ(VerdictOf(Gate::kMaterial, ranking, most), Verdict::kExplained);
  EXPECT_EQ(VerdictOf(Gate::kMaterial, ranking, half), Verdict::kPartlyExplained);
  // Likelier than all else together, but not by nine to one.
  ranking.fits.front().probability = 0.85;
  EXPECT_EQ(VerdictOf(Gate::kMaterial, ranking, most), Verdict::kUnknownCause);
}

TEST(Verdict, FollowsUpWhatIsLikelierThanNot) {
  Ranking ranking;
  EXPECT_FALSE(IsLikely(Gate::kMaterial, ranking));
  ranking.fits.emplace_back();
  ranking.unknown = 0.4;
  EXPECT_TRUE(IsLikely(Gate::kMaterial, ranking));
  EXPECT_FALSE(IsLikely(Gate::kUndecided, ranking));
  ranking.unknown = 0.6;
  EXPECT_FALSE(IsLikely(Gate::kMaterial, ranking));
}

/// At its typical size, shaped as usual.
ModelledEffect Usual(const char* name) {
  ModelledEffect modelled{FindEffect(name), {}};
  for (const EffectParameter& parameter : modelled.effect->Parameters()) {
    modelled.values.push_back(parameter.shapes ? parameter.usual : parameter.typical);
  }
  return modelled;
}

struct RankedBoat {
  UncertainModel model = UncertainModelOf(testing::KnownStableBoat()).value();
  std::vector<Slot> slots = SlotsOf(EffectLibrary());
  PreparedDataset sailed = testing::SailWithEffects({}, 120.0, 500);
  FreeRuns runs{sailed, model.model, 5.0};
  Healthy healthy = LearnHealthy({runs}, model, slots, 2);
  Sensitivity recording = SensitivityOf(runs, healthy.boat, model, slots, 2);
  Judge judge{healthy, recording, EveryWindow(recording), false};

  EffectFit Scored(const char* effect, double score) const {
    EffectFit fit;
    fit.effects = {Usual(effect)};
    fit.score = score;
    fit.errors = recording.errors;
    fit.square = judge.Square(judge.See(fit.errors));
    return fit;
  }
};

// Two explanations that predict the same are one class with the probability of both; one that only
// shakes predicts no path, and is none of theirs.
TEST(Rank, PutsWhatPredictsTheSameIntoOneClass) {
  const RankedBoat boat;
  Explanations explanations;
  explanations.singles = {boat.Scored("thruster_lag", -40.0), boat.Scored("thruster_delay", -38.0),
                          boat.Scored("waves", -36.0)};
  const Ranking ranking = Rank(explanations, boat.judge, kLikeHealth);
  ASSERT_EQ(ranking.fits.size(), 2U);
  EXPECT_EQ(ranking.fits[0].Indistinguishable(), std::vector<std::string>{"thruster_delay"});
  EXPECT_EQ(ranking.fits[1].fit.Names(), std::vector<std::string>{"waves"});
  double sum = ranking.nothing + ranking.unknown;
  for (const RankedFit& ranked : ranking.fits) sum += ranked.probability;
  EXPECT_NEAR(sum, 1.0, 1e-12);
}

// The more an explanation leaves, the likelier it is something else.
TEST(Rank, DoubtsWhatLeavesMuch) {
  const RankedBoat boat;
  Explanations explanations;
  explanations.singles = {boat.Scored("thruster_lag", -40.0)};
  double less_doubt = -1.0;
  for (const double after : {0.9, 1.5, 3.0, 8.0, 20.0}) {
    const Ranking ranking =
        Rank(explanations, boat.judge, {.before = 20.0, .after = after, .healthy = 1.0});
    EXPECT_GT(ranking.unknown, less_doubt) << after;
    less_doubt = ranking.unknown;
  }
  EXPECT_GT(less_doubt, 0.95);
}

// Where little speaks for an explanation, as little is missed of what another leaves.
TEST(Rank, DoubtsWhatLittleSpeaksFor) {
  const RankedBoat boat;
  const auto doubt = [&](double score) {
    Explanations explanations;
    explanations.singles = {boat.Scored("thruster_lag", score)};
    const Remainder closed{.before = 2.0, .after = 1.0, .healthy = 1.0};
    return Rank(explanations, boat.judge, closed).unknown;
  };
  EXPECT_GT(doubt(-10.0), doubt(-20.0));
  EXPECT_GT(doubt(-20.0), doubt(-100.0));
  EXPECT_LT(doubt(-100.0), 0.05);
}

// Two that mend between them what neither of them is are likelier to be mistaken than one.
TEST(Rank, DoubtsSeveralTogetherSooner) {
  const RankedBoat boat;
  Explanations alone;
  alone.singles = {boat.Scored("thruster_lag", -40.0)};
  Explanations together = alone;
  together.together = {boat.Scored("wind", -60.0)};
  together.together.front().effects.push_back(Usual("thruster_lag"));
  const Remainder remainder{.before = 20.0, .after = 2.0, .healthy = 1.0};
  EXPECT_GT(Rank(together, boat.judge, remainder).unknown,
            Rank(alone, boat.judge, remainder).unknown);
}

// What could be learnt from the rest is something that the explanation lacks; that nothing can be
// learnt does not make it the likelier.
TEST(Rank, DoubtsWhatLeavesSomethingToLearn) {
  const RankedBoat boat;
  Explanations explanations;
  explanations.singles = {boat.Scored("thruster_lag", -40.0)};
  const auto doubt = [&](double learnable) {
    const Remainder remainder{.before = 20.0, .after = 2.0, .healthy = 1.0, .learnable = learnable};
    return Rank(explanations, boat.judge, remainder).unknown;
  };
  EXPECT_GT(doubt(0.3), doubt(0.0));
  EXPECT_EQ(doubt(-0.3), doubt(0.0));
}

// A load as far forward as there is boat, or twice its mass, is as much of a load: only where it
// would have to be to explain what is seen makes it doubtful.
TEST(Rank, DoubtsWhatHadToBeBent) {
  const RankedBoat boat;
  const auto doubt = [&](double mass_gain, double forward_m) {
    Explanations explanations;
    explanations.singles = {boat.Scored("payload", -40.0)};
    explanations.singles.front().effects.front().values = {mass_gain, forward_m};
    const Remainder remainder{.before = 20.0, .after = 2.0, .healthy = 1.0};
    return Rank(explanations, boat.judge, remainder).unknown;
  };
  EXPECT_GT(doubt(0.2, 0.3), doubt(0.2, 0.0));
  EXPECT_GT(doubt(0.2, -0.6), doubt(0.2, 0.3));
  EXPECT_EQ(doubt(0.4, 0.3), doubt(0.2, 0.3));
}

TEST(EffectFit, IsStrainedByShapesInSpreads) {
  EffectFit fit;
  fit.effects = {Usual("payload")};
  EXPECT_EQ(fit.Strain(), 0.0);
  const EffectParameter& forward = fit.effects.front().effect->Parameters()[1];
  fit.effects.front().values[1] = forward.usual + 3.0 * forward.typical;
  EXPECT_NEAR(fit.Strain(), 4.5, 1e-12);
}

}  // namespace
}  // namespace telltale
