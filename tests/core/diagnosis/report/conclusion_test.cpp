#include "telltale/core/diagnosis/report/conclusion.hpp"

#include <gtest/gtest.h>

#include "support/hand_made_diagnosis.hpp"

namespace telltale {
namespace {

constexpr double kStrongEvidence = -20.0;

/// What is concluded from a nominal recording where one effect has strong evidence.
Conclusion ConcludedFromANominalRecording(const char* name, std::vector<double> values) {
  const testing::LearnedBaseline day;
  const ResidualMetric metric(day.nominal, day.recording, EveryWindow(day.recording), false);
  const ObservedExcitation excitation;
  const DiagnosisProblem problem{day.runs, day.nominal,        day.recording,
                                 metric,   day.parameter_refs, excitation};
  const HorizonErrors main{
      day.runs, NoiseFloorOf(testing::RunsOf(day.dataset, day.model.model), day.nominal.boat),
      day.recording.errors};
  EffectFit fit;
  fit.effects = {{FindEffect(name), std::move(values)}};
  fit.score = kStrongEvidence;
  fit.square = metric.SquaredMahalanobis(metric.Whiten(day.recording.errors));
  fit.errors = day.recording.errors;
  Hypotheses hypotheses;
  hypotheses.singles = {fit};
  return Conclude(hypotheses, problem, main, 1);
}

TEST(Conclusion, FindsAGapThatEvidenceShowsAndSizeDoesNot) {
  const Conclusion conclusion = ConcludedFromANominalRecording("thruster_imbalance", {0.01});
  EXPECT_FALSE(conclusion.excess_explained.has_value());
  EXPECT_EQ(conclusion.assessment, GapAssessment::kMaterial);
}

TEST(Conclusion, FindsNoLossThatComesAndGoesWhereErrorsAreNoLarger) {
  const Conclusion conclusion = ConcludedFromANominalRecording("intermittent_thrust_loss", {0.05});
  EXPECT_FALSE(conclusion.excess_explained.has_value());
  EXPECT_EQ(conclusion.verdict, Verdict::kNoMaterialGap);
}

}  // namespace
}  // namespace telltale
