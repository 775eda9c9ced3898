#include "telltale/core/diagnosis/diagnose.hpp"

#include <cmath>
#include <numbers>
#include <string_view>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/stable_boat_with_effects.hpp"
#include "support/unlisted_effects.hpp"
#include "telltale/core/diagnosis/hypotheses/augmented_identification.hpp"

namespace telltale {
namespace {

using ::testing::HasSubstr;

constexpr double kDurationS = 300.0;

const std::vector<PreparedDataset>& NominalRecordings() {
  static const std::vector<PreparedDataset> days = [] {
    std::vector<PreparedDataset> all;
    for (const std::uint64_t seed : {11, 12, 13}) {
      all.push_back(testing::SimulateWithEffects({}, kDurationS, 100 * seed));
    }
    return all;
  }();
  return days;
}

DiagnoseOptions TwoThreads() {
  DiagnoseOptions options;
  options.threads = 2;
  return options;
}

Result<DiagnosedModel> DiagnosedWith(const std::vector<ModelledEffect>& effects,
                                     std::uint64_t seed = 7000) {
  return Diagnose(testing::SimulateWithEffects(effects, kDurationS, seed), NominalRecordings(),
                  testing::KnownStableBoat(), "stable", TwoThreads());
}

const Cause& FirstCause(const Result<DiagnosedModel>& diagnosed) {
  return diagnosed->diagnosis.causes.front();
}

TEST(Diagnose, FindsNoMaterialGapWithoutAnEffect) {
  const auto diagnosed = DiagnosedWith({});
  ASSERT_TRUE(diagnosed.has_value());
  EXPECT_EQ(diagnosed->diagnosis.verdict, Verdict::kNoMaterialGap);
  EXPECT_FALSE(diagnosed->augmented.has_value());
  EXPECT_THAT(diagnosed->diagnosis.sentence, HasSubstr("No material gap"));
}

TEST(Diagnose, NamesAWeakThrusterAndItsLoss) {
  const auto diagnosed = DiagnosedWith({{FindEffect("thruster_imbalance"), {-0.2}}});
  ASSERT_TRUE(diagnosed.has_value());
  EXPECT_EQ(diagnosed->diagnosis.verdict, Verdict::kExplained);
  const Cause& cause = FirstCause(diagnosed);
  ASSERT_EQ(cause.effects.size(), 1U);
  EXPECT_EQ(cause.effects[0].effect, "thruster_imbalance");
  EXPECT_GT(cause.probability, 0.9);
  const ParameterEstimate& loss = cause.effects[0].parameters[0];
  EXPECT_NEAR(loss.estimate, -0.2, 4.0 * loss.standard_error);
  EXPECT_LT(loss.standard_error, 0.02);
  ASSERT_TRUE(cause.excess_explained.has_value());
  EXPECT_GT(cause.excess_explained->share, 0.9);
  EXPECT_THAT(diagnosed->diagnosis.sentence, HasSubstr("Starboard thruster"));
}

TEST(Diagnose, SeparatesSensorFaultsFromForces) {
  const auto diagnosed = DiagnosedWith({{FindEffect("gnss_latency"), {0.3}}});
  ASSERT_TRUE(diagnosed.has_value());
  const Cause& cause = FirstCause(diagnosed);
  ASSERT_EQ(cause.effects.size(), 1U);
  EXPECT_EQ(cause.effects[0].effect, "gnss_latency");
  EXPECT_NEAR(cause.effects[0].parameters[0].estimate, 0.3, 0.05);
}

TEST(Diagnose, NamesTwoEffectsThatActTogether) {
  const auto diagnosed =
      DiagnosedWith({{FindEffect("thruster_lag"), {0.4}}, {FindEffect("heading_bias"), {0.09}}});
  ASSERT_TRUE(diagnosed.has_value());
  std::vector<std::string> named;
  double shared = 0.0;
  for (const CausalEffect& effect : FirstCause(diagnosed).effects) {
    named.push_back(effect.effect);
    shared += effect.shapley_share;
  }
  EXPECT_THAT(named, ::testing::UnorderedElementsAre("thruster_lag", "heading_bias"));
  EXPECT_NEAR(shared, 1.0, 1e-9);  // Shapley shares add up to one
}

TEST(Diagnose, NamesWavesByTheirFrequency) {
  const testing::Swell swell;
  const auto diagnosed = DiagnosedWith({{&swell, {}}});
  ASSERT_TRUE(diagnosed.has_value());
  ASSERT_FALSE(diagnosed->diagnosis.causes.empty());
  const Cause& cause = FirstCause(diagnosed);
  ASSERT_EQ(cause.effects.size(), 1U);
  EXPECT_EQ(cause.effects[0].effect, "waves");
  // The grid of frequencies is 20 % wide.
  EXPECT_NEAR(cause.effects[0].parameters[3].estimate, testing::Swell::kFrequency, 0.5);
  // Windows scatter by up to 2.8 times what the spectrum says.
  ASSERT_TRUE(cause.effects[0].size.has_value());
  EXPECT_NEAR(cause.effects[0].size->estimate, 0.2 * std::numbers::sqrt2, 0.25);
  EXPECT_TRUE(cause.effects[0].towards.has_value());
}

/// The same in trains of 35 s, as ships pass every two minutes, and calm between.
class Wash final : public testing::Swell {
 public:
  Wash() : testing::Swell("wash") {}
  NuDot AddedAcceleration(EffectValues values, const InstantState& instant) const override {
    return std::fmod(instant.time_s, 120.0) < 35.0
               ? testing::Swell::AddedAcceleration(values, instant)
               : NuDot{};
  }
};

TEST(Diagnose, DoesNotNameWavesForTheWashOfShips) {
  const Wash wash;
  const auto diagnosed = DiagnosedWith({{&wash, {}}});
  ASSERT_TRUE(diagnosed.has_value());
  EXPECT_EQ(diagnosed->diagnosis.verdict, Verdict::kUnknownCause);
  ASSERT_FALSE(diagnosed->diagnosis.causes.empty());
  EXPECT_EQ(FirstCause(diagnosed).effects.size(), 0U);
}

/// Wind towards the east whose speed scatters by a fifth within half a minute.
class Gusts final : public testing::Unlisted {
 public:
  static constexpr double kSpeed = 8.0;

  Gusts() : testing::Unlisted("gusts") {}
  NuDot AddedAcceleration(EffectValues, const InstantState& instant) const override {
    const double t = instant.time_s;
    const double speed = kSpeed * (1.0 + 0.2 * std::sin(0.21 * t) + 0.2 * std::sin(0.53 * t + 1.0));
    const double ahead = std::sin(instant.psi_rad);
    const double aside = std::cos(instant.psi_rad);
    return {0.0028 * speed * speed * ahead, 0.004 * speed * speed * aside, 0.0};
  }
};

// The mean wind explains a part of the gap. What gusts add does not lower the probability.
TEST(Diagnose, NamesWindInGusts) {
  const Gusts gusts;
  const auto diagnosed = DiagnosedWith({{&gusts, {}}});
  ASSERT_TRUE(diagnosed.has_value());
  ASSERT_FALSE(diagnosed->diagnosis.causes.empty());
  const Cause& cause = FirstCause(diagnosed);
  ASSERT_EQ(cause.effects.size(), 1U);
  EXPECT_EQ(cause.effects[0].effect, "wind");
  EXPECT_GT(cause.probability, 0.9);
  const auto& parameters = cause.effects[0].parameters;
  EXPECT_NEAR(parameters[0].estimate, 0.0, 4.0 * parameters[0].standard_error);
  EXPECT_NEAR(parameters[1].estimate, Gusts::kSpeed, 4.0 * parameters[1].standard_error);
  // A drag that is known to 30 % leaves the speed uncertain by half of that.
  EXPECT_GT(parameters[1].standard_error, 0.1 * Gusts::kSpeed);
  const CausalEffect& wind = cause.effects[0];
  ASSERT_TRUE(wind.size.has_value() && wind.towards.has_value());
  EXPECT_NEAR(wind.size->estimate, Gusts::kSpeed, 4.0 * wind.size->standard_error);
  EXPECT_NEAR(wind.towards->centre_rad, std::numbers::pi / 2.0, 2.0 * wind.towards->half_width_rad);
  EXPECT_LT(wind.towards->half_width_rad, std::numbers::pi / 4.0);
}

TEST(Diagnose, SaysWhatADiagnosisWithoutEachReferenceWouldSay) {
  const PreparedDataset recording =
      testing::SimulateWithEffects({{FindEffect("thruster_imbalance"), {-0.2}}}, 120.0, 7000);
  DiagnoseOptions options = TwoThreads();
  options.advise = options.state_power = false;
  options.leave_out_references = true;
  const auto model = testing::KnownStableBoat();
  const auto all = Diagnose(recording, NominalRecordings(), model, "stable", options);
  ASSERT_TRUE(all.has_value());
  const auto& influences = all->diagnosis.reference_influence;
  ASSERT_EQ(influences.size(), NominalRecordings().size());
  options.leave_out_references = false;
  for (std::size_t left_out = 0; left_out < influences.size(); ++left_out) {
    std::vector<PreparedDataset> others = NominalRecordings();
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(left_out));
    const auto without = Diagnose(recording, others, model, "stable", options);
    ASSERT_TRUE(without.has_value());
    EXPECT_EQ(influences[left_out].verdict, without->diagnosis.verdict);
    EXPECT_EQ(influences[left_out].effects, std::vector<std::string>{"thruster_imbalance"});
    EXPECT_NEAR(influences[left_out].probability, FirstCause(without).probability, 0.05);
    const double gap = without->diagnosis.Main().all.before;
    EXPECT_NEAR(influences[left_out].gap.before, gap, 0.1 * gap);
    EXPECT_TRUE(influences[left_out].own_gap.has_value());
  }
}

TEST(Diagnose, NamesNoWrongEffectWithoutTheRightOne) {
  DiagnoseOptions options = TwoThreads();
  options.without = {"antenna_lever_arm"};
  const auto diagnosed =
      Diagnose(testing::SimulateWithEffects({{FindEffect("antenna_lever_arm"), {0.8, 0.6}}},
                                            kDurationS, 7000),
               NominalRecordings(), testing::KnownStableBoat(), "stable", options);
  ASSERT_TRUE(diagnosed.has_value());
  EXPECT_NE(diagnosed->diagnosis.verdict, Verdict::kNoMaterialGap);
  EXPECT_NE(diagnosed->diagnosis.verdict, Verdict::kExplained);
}

TEST(Diagnose, ReidentifiedModelPredictsTheRecordingBetter) {
  const auto diagnosed = DiagnosedWith({{FindEffect("thrust_gain"), {0.3}}});
  ASSERT_TRUE(diagnosed.has_value());
  ASSERT_TRUE(diagnosed->augmented.has_value());
  ASSERT_FALSE(diagnosed->augmented->effects.empty());
  const PreparedDataset another =
      testing::SimulateWithEffects({{FindEffect("thrust_gain"), {0.3}}}, kDurationS, 9100);
  const auto old = Validate(another, testing::StableBoat(), {});
  const auto now = Validate(another, AugmentedModelOf(*diagnosed->augmented).value(), {});
  ASSERT_TRUE(old.has_value() && now.has_value());
  // Surge errors of 30 % less thrust are far above sensor noise.
  EXPECT_LT(now->free_run[1].velocity[0].rmse, 0.3 * old->free_run[1].velocity[0].rmse);
}

TEST(Diagnose, StartsFromTheSimulationParameters) {
  const PreparedDataset recording =
      testing::SimulateWithEffects({{FindEffect("thrust_gain"), {0.3}}}, 120.0, 7000);
  const Identification known = testing::KnownStableBoat();
  Identification off = known;
  for (Coefficient& c : off.coefficients) {
    off.simulation.push_back(c.estimate);
    c.estimate += 0.9 * c.standard_error;
  }
  const auto a = Diagnose(recording, NominalRecordings(), known, "stable", TwoThreads());
  const auto b = Diagnose(recording, NominalRecordings(), off, "stable", TwoThreads());
  ASSERT_TRUE(a.has_value() && b.has_value());
  EXPECT_EQ(a->diagnosis.sentence, b->diagnosis.sentence);
  ASSERT_TRUE(a->augmented.has_value() && b->augmented.has_value());
  EXPECT_EQ(ModelOf(*a->augmented)->theta, ModelOf(*b->augmented)->theta);
  EXPECT_EQ(b->augmented->coefficients[5].estimate, ModelOf(*b->augmented)->theta[0][5]);
}

TEST(Diagnose, DoesNotDependOnThreads) {
  const PreparedDataset recording =
      testing::SimulateWithEffects({{FindEffect("hull_fouling"), {0.6, 0.5}}}, 120.0, 7000);
  DiagnoseOptions one;
  one.advise = false;
  DiagnoseOptions two = one;
  two.threads = 2;
  const auto model = testing::KnownStableBoat();
  const auto a = Diagnose(recording, NominalRecordings(), model, "stable", one);
  const auto b = Diagnose(recording, NominalRecordings(), model, "stable", two);
  ASSERT_TRUE(a.has_value() && b.has_value());
  EXPECT_EQ(a->diagnosis.sentence, b->diagnosis.sentence);
  EXPECT_EQ(a->diagnosis.Main().all.after, b->diagnosis.Main().all.after);
  ASSERT_EQ(a->diagnosis.causes.size(), b->diagnosis.causes.size());
  EXPECT_EQ(a->diagnosis.causes[0].probability, b->diagnosis.causes[0].probability);
}

TEST(Diagnose, RestsOnSensorNoiseWithoutReferences) {
  const auto diagnosed = Diagnose(testing::SimulateWithEffects({}, 120.0, 7000), {},
                                  testing::KnownStableBoat(), "stable", TwoThreads());
  ASSERT_TRUE(diagnosed.has_value());
  EXPECT_EQ(diagnosed->diagnosis.floor_basis, FloorBasis::kSensorNoise);
  EXPECT_EQ(diagnosed->diagnosis.reference_logs, 0U);
}

TEST(Diagnose, RefusesShortRecordingsOtherBoatsAndOptionsOutOfRange) {
  const auto model = testing::KnownStableBoat();
  const auto shorter = Diagnose(testing::SimulateWithEffects({}, 40.0, 7000), NominalRecordings(),
                                model, "stable", {});
  ASSERT_FALSE(shorter.has_value());
  EXPECT_THAT(shorter.error().advice, HasSubstr("60 s"));

  const PreparedDataset recording = testing::SimulateWithEffects({}, 90.0, 7000);
  const auto other = Diagnose(recording, NominalRecordings(), model, "another", {});
  ASSERT_FALSE(other.has_value());
  EXPECT_THAT(other.error().reason, HasSubstr("another"));

  DiagnoseOptions unknown;
  unknown.without = {"magnetism"};
  const auto no_such = Diagnose(recording, NominalRecordings(), model, "stable", unknown);
  ASSERT_FALSE(no_such.has_value());
  EXPECT_THAT(no_such.error().reason, HasSubstr("magnetism"));
  EXPECT_THAT(no_such.error().advice, HasSubstr("thruster_lag"));

  DiagnoseOptions four;
  four.most_effects = 4;
  EXPECT_FALSE(Diagnose(recording, NominalRecordings(), model, "stable", four).has_value());
}

TEST(Diagnose, RecognisesSwappedAndReversedThrusters) {
  const PreparedDataset recording = testing::SimulateWithEffects({}, 90.0, 7000);
  const auto rewired = [&](auto change) {
    PreparedDataset changed = recording;
    for (HeldCommands& commands : changed.commands) commands.ForEachCommand(change);
    return Diagnose(changed, NominalRecordings(), testing::KnownStableBoat(), "stable", {});
  };
  const auto swapped = rewired([](PropellerCommand d) {
    return PropellerCommand{d.starboard, d.port};
  });
  ASSERT_FALSE(swapped.has_value());
  EXPECT_THAT(swapped.error().reason, HasSubstr("swapped"));
  const auto reversed = rewired([](PropellerCommand d) {
    return PropellerCommand{-d.port, d.starboard};
  });
  ASSERT_FALSE(reversed.has_value());
  EXPECT_THAT(reversed.error().reason, HasSubstr("port thruster seems to be reversed"));
}

}  // namespace
}  // namespace telltale
