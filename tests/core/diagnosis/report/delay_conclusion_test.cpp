#include "telltale/core/diagnosis/report/delay_conclusion.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/hand_made_diagnosis.hpp"
#include "support/physical_boat.hpp"
#include "telltale/core/diagnosis/delays/delay_difference.hpp"
#include "telltale/core/diagnosis/diagnose.hpp"
#include "telltale/core/diagnosis/diagnosis_constants.hpp"

namespace telltale {
namespace {

using ::testing::ElementsAre;

constexpr double kLateS = 0.4;
constexpr DelayDifference kLateFixes{DelayedChannel::kFixes, kLateS, 0.05, -40.0, 0.3};
constexpr DelayDifference kNominalCommands{DelayedChannel::kCommands, 0.02, 0.05, 3.0, 0.3};

/// A recording with effects beside the nominal boat, and what free runs alone conclude from it.
struct ByFreeRuns : testing::LearnedBaseline {
  explicit ByFreeRuns(const std::vector<ModelledEffect>& effects) : altered(120.0, effects) {}

  testing::ShortRecording altered;
  Sensitivity sensitivity =
      SensitivityOf(altered.runs, {nominal.boat, nominal.coefficients}, model, parameter_refs, 2);
  ResidualMetric metric{nominal, sensitivity, EveryWindow(sensitivity), false};
  ObservedExcitation excitation;
  DiagnosisProblem problem{altered.runs, nominal, sensitivity, metric, parameter_refs, excitation};
  HorizonErrors main{altered.runs,
                     NoiseFloorOf(testing::RunsOf(dataset, model.model), nominal.boat),
                     sensitivity.errors};
};

Conclusion Concluded(Verdict verdict, GapAssessment assessment) {
  Conclusion conclusion;
  conclusion.verdict = verdict;
  conclusion.assessment = assessment;
  return conclusion;
}

Conclusion Concluded(const std::vector<ModelledEffect>& effects, Conclusion conclusion,
                     const std::vector<DelayDifference>& delays,
                     std::span<const Effect* const> library = EffectLibrary()) {
  const ByFreeRuns free_runs(effects);
  ConcludeFromDelays(delays, library, free_runs.problem, free_runs.main, 1, conclusion);
  return conclusion;
}

Conclusion NoGap() {
  return Concluded(Verdict::kNoMaterialGap, GapAssessment::kWithinNominal);
}

TEST(DelayConclusion, NamesALateChannelThatFreeRunsDoNotShow) {
  const Conclusion conclusion = Concluded({}, NoGap(), {kNominalCommands, kLateFixes});
  EXPECT_EQ(conclusion.assessment, GapAssessment::kMaterial);
  EXPECT_TRUE(conclusion.is_likely);
  EXPECT_THAT(conclusion.best.Names(), ElementsAre("gnss_latency"));
  EXPECT_THAT(conclusion.best.Values(), ElementsAre(kLateS));
  EXPECT_NEAR(conclusion.best.covariance(0, 0), 0.05 * 0.05, 1e-12);
  // Odds of e^20 to one.
  EXPECT_NEAR(conclusion.ranking.no_effect, std::exp(-20.0), 1e-12);
  EXPECT_DOUBLE_EQ(conclusion.ranking.fits.front().probability + conclusion.ranking.no_effect, 1.0);
}

TEST(DelayConclusion, ExplainsAGapThatTheDelayMakes) {
  const ModelledEffect late_fixes{FindEffect("gnss_latency"), {kLateS}};
  const Conclusion conclusion =
      Concluded({late_fixes}, Concluded(Verdict::kUnknownCause, GapAssessment::kMaterial),
                {kNominalCommands, kLateFixes});
  EXPECT_EQ(conclusion.verdict, Verdict::kExplained);
  ASSERT_TRUE(conclusion.excess_explained.has_value());
  EXPECT_GT(conclusion.excess_explained->share, 0.9);
}

TEST(DelayConclusion, LeavesAGapUnknownThatTheDelayDoesNotExplain) {
  const ModelledEffect weak_thruster{FindEffect("thruster_imbalance"), {0.4}};
  const Conclusion conclusion =
      Concluded({weak_thruster}, Concluded(Verdict::kUnknownCause, GapAssessment::kMaterial),
                {kNominalCommands, kLateFixes});
  EXPECT_EQ(conclusion.verdict, Verdict::kUnknownCause);
  EXPECT_TRUE(conclusion.ranking.fits.empty());
}

TEST(DelayConclusion, LeavesACauseThatExplainsAGap) {
  Conclusion by_free_runs = Concluded(Verdict::kPartlyExplained, GapAssessment::kMaterial);
  by_free_runs.excess_explained = ExcessExplained{0.5, {0.95, 0.4, 0.6}};
  const Conclusion conclusion = Concluded({}, by_free_runs, {kLateFixes});
  EXPECT_EQ(conclusion.verdict, Verdict::kPartlyExplained);
  EXPECT_TRUE(conclusion.ranking.fits.empty());
}

TEST(DelayConclusion, TakesTheLikelierCauseWhereThereIsNoGapToExplain) {
  Conclusion by_free_runs = Concluded(Verdict::kExplained, GapAssessment::kMaterial);
  by_free_runs.best.score = kLateFixes.score - 1.0;
  EXPECT_TRUE(Concluded({}, by_free_runs, {kLateFixes}).ranking.fits.empty());
  by_free_runs.best.score = kLateFixes.score + 1.0;
  EXPECT_THAT(Concluded({}, by_free_runs, {kLateFixes}).best.Names(), ElementsAre("gnss_latency"));
}

TEST(DelayConclusion, DoesNotTellLateCommandsFromAThrustThatFollowsSlowly) {
  constexpr DelayDifference kLateCommands{DelayedChannel::kCommands, kLateS, 0.05, -40.0, 0.3};
  const RankedHypothesis late = Concluded({}, NoGap(), {kLateCommands}).ranking.fits.front();
  EXPECT_THAT(late.fit.Names(), ElementsAre("thruster_delay"));
  EXPECT_THAT(late.Indistinguishable(), ElementsAre("thruster_lag", "output_slew"));
  const RankedHypothesis both =
      Concluded({}, NoGap(), {kLateCommands, kLateFixes}).ranking.fits.front();
  EXPECT_THAT(both.fit.Names(), ElementsAre("thruster_delay", "gnss_latency"));
  EXPECT_THAT(both.Indistinguishable(), ElementsAre("thruster_lag", "output_slew"));
}

TEST(DelayConclusion, NamesNoEffectThatTheLibraryLacks) {
  const std::array<const Effect*, 1> library = {FindEffect("wind")};
  EXPECT_EQ(Concluded({}, NoGap(), {kLateFixes}, library).verdict, Verdict::kNoMaterialGap);
}

TEST(DelayConclusion, NamesNothingWhereNoChannelIsLate) {
  EXPECT_EQ(Concluded({}, NoGap(), {kNominalCommands}).verdict, Verdict::kNoMaterialGap);
  EXPECT_EQ(Concluded({}, NoGap(), {}).verdict, Verdict::kNoMaterialGap);
}

PreparedDataset Day(std::uint64_t seed, const std::vector<ModelledEffect>& effects = {}) {
  return testing::SimulatePhysicalBoat(testing::PhysicalBoat(), 200.0, seed, effects);
}

Result<DiagnosedModel> Diagnosed(const PreparedDataset& recording) {
  const std::vector<PreparedDataset> references = {Day(1), Day(2), Day(3)};
  DiagnoseOptions options;
  options.threads = 2;
  return Diagnose(recording, references, testing::KnownPhysicalBoat(testing::PhysicalBoat(), 0.02),
                  "stable", options);
}

TEST(DiagnosedDelays, AreThoseOfTheRecordingBesideItsReferences) {
  const auto diagnosed = Diagnosed(Day(4, {{FindEffect("gnss_latency"), {kLateS}}}));
  ASSERT_TRUE(diagnosed) << diagnosed.error().reason;
  const auto& delays = diagnosed->diagnosis.delays;
  ASSERT_EQ(delays.size(), kDelayedChannels.size());
  EXPECT_NEAR(delays[0].difference_s, 0.0, 4.0 * delays[0].standard_deviation_s);
  EXPECT_NEAR(delays[1].difference_s, kLateS, 4.0 * delays[1].standard_deviation_s);
  EXPECT_FALSE(IsLate(delays[0]));
  EXPECT_TRUE(IsLate(delays[1]));
}

TEST(DiagnosedDelays, StateTheSizeThatWouldShow) {
  const auto diagnosed = Diagnosed(Day(4));
  ASSERT_TRUE(diagnosed) << diagnosed.error().reason;
  const Diagnosis& diagnosis = diagnosed->diagnosis;
  EXPECT_EQ(diagnosis.verdict, Verdict::kNoMaterialGap);
  for (const DelayDifference& delay : diagnosis.delays) {
    ASSERT_TRUE(delay.detectable_s.has_value());
    const auto effect = std::ranges::find(diagnosis.effects, EffectOf(delay.channel).Name(),
                                          &EffectTestability::effect);
    ASSERT_NE(effect, diagnosis.effects.end());
    ASSERT_TRUE(effect->detectable_sizes.front().size.has_value());
    EXPECT_LE(*effect->detectable_sizes.front().size, *delay.detectable_s);
    const double sigmas =
        EffectOf(delay.channel).Parameters().front().typical / delay.standard_deviation_s;
    ASSERT_GE(sigmas, kDiagnosis.testability.detectable_sigmas);
    EXPECT_GE(effect->detectability, sigmas);
    EXPECT_EQ(effect->testability, Testability::kTestable);
  }
}

TEST(DiagnosedDelays, AreNoneWithoutReferences) {
  const auto diagnosed =
      Diagnose(Day(4), {}, testing::KnownPhysicalBoat(testing::PhysicalBoat(), 0.02), "stable", {});
  ASSERT_TRUE(diagnosed) << diagnosed.error().reason;
  EXPECT_TRUE(diagnosed->diagnosis.delays.empty());
}

}  // namespace
}  // namespace telltale
