#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "baselines/accelerations.hpp"
#include "baselines/best_bic.hpp"
#include "baselines/regressions.hpp"
#include "score/figures.hpp"
#include "support/stable_boat_with_effects.hpp"

namespace blind::baselines {
namespace {

using telltale::FindEffect;
using telltale::ModelledEffect;

constexpr double kDurationS = 200.0;

/// The stable boat with effects, against two nominal days of it.
DiagnosisInputs DaysWith(const std::vector<ModelledEffect>& effects) {
  DiagnosisInputs inputs{
      .model = telltale::UncertainModelOf(telltale::testing::KnownStableBoat()).value(),
      .recording = telltale::testing::SimulateWithEffects(effects, kDurationS, 7000),
      .references = {}};
  for (const std::uint64_t seed : {1100, 1200}) {
    inputs.references.push_back(telltale::testing::SimulateWithEffects({}, kDurationS, seed));
  }
  return inputs;
}

score::Report Said(const std::vector<ScoredExplanation>& explanations,
                   const ReferenceBasis& basis) {
  return score::ParseReport(ReportOf(explanations, basis));
}

TEST(Baselines, NameAWeakThruster) {
  const DiagnosisInputs inputs = DaysWith({{FindEffect("thruster_imbalance"), {-0.2}}});
  const ReferenceBasis basis(inputs);
  for (const auto& method : {BestBic, Stepwise, Sparse}) {
    const score::Report report = Said(method(basis), basis);
    EXPECT_EQ(report.verdict, "EXPLAINED");
    ASSERT_FALSE(report.causes.empty());
    EXPECT_EQ(report.causes[0].effects, score::EffectSet{"thruster_imbalance"});
    // An output partly stuck at a command of zero is the same boat with one parameter more, for
    // which BIC leaves it a weight of 1 / sqrt(n), n the windows: here a fifth.
    EXPECT_GT(report.causes[0].probability, 0.75);
    ASSERT_TRUE(report.closure.has_value());
    EXPECT_NEAR(*report.closure, 1.0, 0.1);
  }
}

TEST(Baselines, NameOldFixesCausally) {
  const DiagnosisInputs inputs = DaysWith({{FindEffect("gnss_latency"), {0.4}}});
  const ReferenceBasis basis(inputs);
  for (const auto& method : {BestBic, Stepwise}) {
    const score::Report report = Said(method(basis), basis);
    ASSERT_FALSE(report.causes.empty());
    EXPECT_TRUE(report.causes[0].effects.contains("gnss_latency"));
  }
  // Whoever started from fixes yet to come would miss nothing: signature and misses would be one.
  const DiagnosisInputs nominal = DaysWith({});
  const ReferenceBasis calm(nominal);
  const Accelerations accelerations = AccelerationsOf(calm);
  for (std::size_t i = 0; i < calm.parameter_refs.size(); ++i) {
    if (calm.parameter_refs[i].effect->Name() != "gnss_latency") continue;
    const auto signature = accelerations.signatures.col(static_cast<Eigen::Index>(i));
    EXPECT_LT(std::abs(signature.normalized().dot(accelerations.residuals.normalized())), 0.3);
  }
}

TEST(Baselines, FindNoEffectOnANominalBoatOnlyIfNoEffectIsACandidate) {
  const DiagnosisInputs inputs = DaysWith({});
  const ReferenceBasis basis(inputs);
  EXPECT_EQ(Said(Stepwise(basis), basis).verdict, "NO_MATERIAL_GAP");
  EXPECT_EQ(Said(Sparse(basis), basis).verdict, "NO_MATERIAL_GAP");
  EXPECT_EQ(Said(BestBic(basis), basis).verdict, "EXPLAINED") << "it always names one";
}

TEST(ReportOf, WeightsExplanationsByTheirCriterion) {
  const DiagnosisInputs inputs = DaysWith({});
  const ReferenceBasis basis(inputs);
  const auto explanation = [](const char* effect, double bic) {
    return ScoredExplanation{{{FindEffect(effect), {0.1}}}, bic};
  };
  const score::Report report = Said(
      {explanation("thrust_gain", 12.0), explanation("gnss_latency", 10.0), {{}, 1000.0}}, basis);
  ASSERT_EQ(report.causes.size(), 2u);
  EXPECT_EQ(report.causes[0].effects, score::EffectSet{"gnss_latency"});
  EXPECT_NEAR(report.causes[0].probability, 1.0 / (1.0 + std::exp(-1.0)), 1e-9);
  EXPECT_EQ(Said({explanation("thrust_gain", 12.0), {{}, 10.0}}, basis).verdict, "NO_MATERIAL_GAP");
}

}  // namespace
}  // namespace blind::baselines
