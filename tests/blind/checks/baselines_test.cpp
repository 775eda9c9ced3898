#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "baselines/accelerations.hpp"
#include "baselines/best_bic.hpp"
#include "baselines/regressions.hpp"
#include "score/figures.hpp"
#include "support/augmented_boats.hpp"

namespace blind::baselines {
namespace {

using telltale::FindEffect;
using telltale::ModelledEffect;

constexpr double kDurationS = 200.0;

/// The stable boat with effects, against two healthy days of it.
Days DaysWith(const std::vector<ModelledEffect>& effects) {
  Days days{.model = telltale::UncertainModelOf(telltale::testing::KnownStableBoat()).value(),
            .recording = telltale::testing::SailWithEffects(effects, kDurationS, 7000),
            .references = {}};
  for (const std::uint64_t seed : {1100, 1200}) {
    days.references.push_back(telltale::testing::SailWithEffects({}, kDurationS, seed));
  }
  return days;
}

score::Report Said(const std::vector<Answer>& answers, const Ground& ground) {
  return score::ParseReport(ReportOf(answers, ground));
}

TEST(Baselines, NameAWeakThruster) {
  const Days days = DaysWith({{FindEffect("thruster_imbalance"), {-0.2}}});
  const Ground ground(days);
  for (const auto& method : {BestBic, Stepwise, Sparse}) {
    const score::Report report = Said(method(ground), ground);
    EXPECT_EQ(report.verdict, "EXPLAINED");
    ASSERT_FALSE(report.causes.empty());
    EXPECT_EQ(report.causes[0].effects, score::EffectSet{"thruster_imbalance"});
    EXPECT_GT(report.causes[0].probability, 0.9);
    ASSERT_TRUE(report.closure.has_value());
    EXPECT_NEAR(*report.closure, 1.0, 0.1);
  }
}

TEST(Baselines, NameOldFixesWithoutLookingAhead) {
  const Days days = DaysWith({{FindEffect("gnss_latency"), {0.4}}});
  const Ground ground(days);
  for (const auto& method : {BestBic, Stepwise}) {
    const score::Report report = Said(method(ground), ground);
    ASSERT_FALSE(report.causes.empty());
    EXPECT_TRUE(report.causes[0].effects.contains("gnss_latency"));
  }
  // Whoever started from fixes yet to come would miss nothing: signature and misses would be one.
  const Days healthy = DaysWith({});
  const Ground calm(healthy);
  const Accelerations accelerations = AccelerationsOf(calm);
  for (std::size_t i = 0; i < calm.slots.size(); ++i) {
    if (calm.slots[i].effect->Name() != "gnss_latency") continue;
    const auto signature = accelerations.signatures.col(static_cast<Eigen::Index>(i));
    EXPECT_LT(std::abs(signature.normalized().dot(accelerations.misses.normalized())), 0.3);
  }
}

TEST(Baselines, TellAHealthyBoatOnlyWhereNothingIsAnAnswer) {
  const Days days = DaysWith({});
  const Ground ground(days);
  EXPECT_EQ(Said(Stepwise(ground), ground).verdict, "NO_MATERIAL_GAP");
  EXPECT_EQ(Said(Sparse(ground), ground).verdict, "NO_MATERIAL_GAP");
  EXPECT_EQ(Said(BestBic(ground), ground).verdict, "EXPLAINED") << "it always names one";
}

TEST(ReportOf, WeighsAnswersByTheirCriterion) {
  const Days days = DaysWith({});
  const Ground ground(days);
  const auto answer = [](const char* effect, double bic) {
    return Answer{{{FindEffect(effect), {0.1}}}, bic};
  };
  const score::Report report =
      Said({answer("thrust_gain", 12.0), answer("gnss_latency", 10.0), {{}, 1000.0}}, ground);
  ASSERT_EQ(report.causes.size(), 2u);
  EXPECT_EQ(report.causes[0].effects, score::EffectSet{"gnss_latency"});
  EXPECT_NEAR(report.causes[0].probability, 1.0 / (1.0 + std::exp(-1.0)), 1e-9);
  EXPECT_EQ(Said({answer("thrust_gain", 12.0), {{}, 10.0}}, ground).verdict, "NO_MATERIAL_GAP");
}

}  // namespace
}  // namespace blind::baselines
