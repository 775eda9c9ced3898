#include <algorithm>
#include <set>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/stable_boat.hpp"
#include "telltale/core/effects/augmented_simulation.hpp"
#include "telltale/core/effects/effect.hpp"

namespace telltale {
namespace {

constexpr double kSimulationStepS = 0.1;

std::vector<double> TypicalValues(const Effect& effect) {
  std::vector<double> values;
  for (const EffectParameter& parameter : effect.Parameters()) {
    values.push_back(parameter.is_shape ? parameter.prior_mean : parameter.typical);
  }
  return values;
}

std::vector<double> NoValues(const Effect& effect) {
  std::vector<double> values;
  for (const EffectParameter& parameter : effect.Parameters())
    values.push_back(parameter.prior_mean);
  return values;
}

Recording SimulatedRecording(const std::vector<ModelledEffect>& effects) {
  const AugmentedModel model{testing::StableBoat(), effects};
  const auto track = Simulate(model, testing::VariedCommands(60.0, 3), 60.0, kSimulationStepS);
  return Measure(track, model, testing::StableBoatVehicle(), testing::NoNoise());
}

bool SameReadings(const Recording& a, const Recording& b) {
  for (std::size_t i = 0; i < a.gnss.size(); ++i) {
    if (a.gnss[i].latitude_deg != b.gnss[i].latitude_deg ||
        a.gnss[i].longitude_deg != b.gnss[i].longitude_deg ||
        a.gnss[i].time_s != b.gnss[i].time_s) {
      return false;
    }
  }
  for (std::size_t i = 0; i < a.heading.size(); ++i) {
    if (a.heading[i].heading_deg != b.heading[i].heading_deg) return false;
  }
  return true;
}

// The effects that the project promises, by the names under which reports give them.
TEST(EffectLibrary, HoldsThePromisedByName) {
  const std::set<std::string> promised = {"wind",
                                          "current",
                                          "current_shear",
                                          "waves",
                                          "body_bias",
                                          "thruster_dead_zone",
                                          "thruster_lag",
                                          "thruster_delay",
                                          "thruster_imbalance",
                                          "thruster_saturation",
                                          "output_slew",
                                          "output_stuck",
                                          "thruster_misalignment",
                                          "thrust_gain",
                                          "thrust_sag",
                                          "thrust_inflow_loss",
                                          "intermittent_thrust_loss",
                                          "payload",
                                          "trim_sinkage",
                                          "hull_fouling",
                                          "crossflow_drag",
                                          "added_mass_coupling",
                                          "heading_bias",
                                          "magnetic_deviation",
                                          "antenna_lever_arm",
                                          "gnss_latency"};
  std::set<std::string> held;
  for (const Effect* effect : EffectLibrary()) held.insert(std::string(effect->Name()));
  EXPECT_EQ(held, promised);
  EXPECT_EQ(EffectLibrary().size(), promised.size());
}

TEST(EffectLibrary, FindsByNameAndNothingElse) {
  ASSERT_NE(FindEffect("wind"), nullptr);
  EXPECT_EQ(FindEffect("wind")->Name(), "wind");
  EXPECT_EQ(FindEffect("Wind"), nullptr);
  EXPECT_EQ(FindEffect(""), nullptr);
}

TEST(EffectLibrary, SaysOfEveryEffectWhatItIs) {
  for (const Effect* effect : EffectLibrary()) {
    SCOPED_TRACE(std::string(effect->Name()));
    EXPECT_FALSE(effect->Facts().title.empty());
    EXPECT_FALSE(effect->Facts().equation.empty());
    EXPECT_FALSE(effect->Facts().source.empty());
    EXPECT_FALSE(effect->Facts().settled_by.empty());
    EXPECT_FALSE(effect->Describe(TypicalValues(*effect)).empty());
    for (const EffectParameter& parameter : effect->Parameters()) {
      EXPECT_GT(parameter.typical, 0.0) << parameter.name;
      EXPECT_LT(parameter.lower, parameter.upper) << parameter.name;
      EXPECT_LE(parameter.lower, parameter.prior_mean) << parameter.name;
      EXPECT_GE(parameter.upper, parameter.prior_mean) << parameter.name;
      EXPECT_LE(parameter.typical, parameter.upper) << parameter.name;
    }
  }
}

// What the search takes for granted of effects that vary.
TEST(EffectLibrary, VariesInWaysThatTheSearchKnows) {
  std::set<double> drift_times_s;
  for (const Effect* effect : EffectLibrary()) {
    const EffectFacts& facts = effect->Facts();
    if (facts.drift_time_s > 0.0) drift_times_s.insert(facts.drift_time_s);
    if (!effect->IsIntermittent()) continue;
    ASSERT_EQ(facts.parameters.size(), 1U) << effect->Name();
    EXPECT_EQ(facts.parameters[0].lower, -facts.parameters[0].upper) << effect->Name();
    EXPECT_TRUE(std::ranges::is_sorted(facts.intermittent_sds)) << effect->Name();
  }
  EXPECT_LE(drift_times_s.size(), 1U);
}

TEST(EffectLibrary, LeavesTheBoatAloneWhereAnEffectIsNotThere) {
  const Recording plain = SimulatedRecording({});
  for (const Effect* effect : EffectLibrary()) {
    EXPECT_TRUE(SameReadings(SimulatedRecording({{effect, NoValues(*effect)}}), plain))
        << effect->Name();
  }
}

// A hook that is overridden but not named in the facts would be silent.
TEST(EffectLibrary, ShowsInTheReadingsWhereAnEffectIsThere) {
  const Recording plain = SimulatedRecording({});
  for (const Effect* effect : EffectLibrary()) {
    if (effect->StochasticExcitation(TypicalValues(*effect))) continue;
    // Commands reach full, so that a cut is felt.
    EXPECT_FALSE(SameReadings(SimulatedRecording({{effect, TypicalValues(*effect)}}), plain))
        << effect->Name();
  }
}

TEST(EffectLibrary, DescribesInAnOperatorsWords) {
  const std::vector<double> starboard = {-0.22};
  EXPECT_EQ(FindEffect("thruster_imbalance")->Describe(starboard),
            "starboard thruster 22 % weaker");
  // Half the turning and half the straining of the gradient, over 50 m.
  const std::vector<double> shear = {0.006, -0.002, 0.0};
  EXPECT_EQ(FindEffect("current_shear")->Describe(shear),
            "a current that changes by up to 0.30 m/s over 50 m");
  const std::vector<double> deviation = {0.1, 0.0, 0.0, 0.0};
  EXPECT_EQ(FindEffect("magnetic_deviation")->Describe(deviation),
            "heading off by up to 5.7 deg, by its direction");
  const std::vector<double> current = {-0.3, 0.4};
  EXPECT_EQ(FindEffect("current")->Describe(current), "0.50 m/s of current towards SE");
}

}  // namespace
}  // namespace telltale
