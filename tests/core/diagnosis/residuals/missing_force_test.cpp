#include "telltale/core/diagnosis/residuals/missing_force.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/stable_boat_with_effects.hpp"
#include "support/unlisted_effects.hpp"
#include "telltale/core/diagnosis/report/missing_force_text.hpp"

namespace telltale {
namespace {

constexpr double kDurationS = 600.0;
// Of the default hull: 35 kg dry, 1.5 times that in sway; I = 35 kg (0.4 m)^2, 1.3 times that.
constexpr double kMass = 35.0;
constexpr double kSwayMass = 1.5 * kMass;
constexpr double kInertia = 1.3 * kMass * 0.4 * 0.4;

/// A force that turns once with the heading: k cos psi ahead, which no effect of a boat has.
class ByHeading final : public testing::Unlisted {
 public:
  static constexpr double kAcceleration = 0.1;

  ByHeading() : testing::Unlisted("by_heading") {}
  NuDot AddedAcceleration(EffectValues, const InstantState& instant) const override {
    return {kAcceleration * std::cos(instant.psi_rad), 0.0, 0.0};
  }
};

MissingForce MissingOf(const std::vector<ModelledEffect>& effects) {
  const PreparedDataset recording = testing::SimulateWithEffects(effects, kDurationS, 31);
  const std::vector<PreparedDataset> references = {
      testing::SimulateWithEffects({}, kDurationS, 32)};
  MissingForce missing = MissingForceOf(recording, references, {testing::StableBoat(), {}});
  missing.sentence = DescribeMissingForce(missing);
  return missing;
}

const ForceProfile& Over(const MissingForce& missing, ForceVariable variable) {
  return *std::find_if(missing.over.begin(), missing.over.end(),
                       [&](const ForceProfile& profile) { return profile.variable == variable; });
}

TEST(MissingForce, OfAConstantAccelerationIsMassTimesIt) {
  const MissingForce missing = MissingOf({{FindEffect("body_bias"), {-0.1, 0.06, 0.08}}});
  EXPECT_EQ(missing.mass_kg, kMass);
  // The robust preset's filter and the sensors leave some thousandths of a m/s^2.
  EXPECT_NEAR(missing.mean[0].mean, -0.1 * kMass, missing.mean[0].half_width + 0.1);
  EXPECT_NEAR(missing.mean[1].mean, 0.06 * kSwayMass, missing.mean[1].half_width + 0.15);
  EXPECT_NEAR(missing.mean[2].mean, 0.08 * kInertia, missing.mean[2].half_width + 0.02);
  EXPECT_GT(missing.constant_share[0], 0.8);
  EXPECT_THAT(missing.sentence, ::testing::HasSubstr("a constant "));
}

TEST(MissingForce, ThatTurnsWithTheHeadingIsShownOverIt) {
  const ByHeading by_heading;
  const MissingForce missing = MissingOf({{&by_heading, {}}});
  const ForceProfile& profile = Over(missing, ForceVariable::kHeading);
  ASSERT_GE(profile.bins.size(), 5U);
  for (const ForceBin& bin : profile.bins) {
    const double middle = 0.5 * (bin.low + bin.high) * std::numbers::pi / 180.0;
    // Headings within a bin are not evenly spread: half a bin is 18 degrees.
    const double expected = kMass * ByHeading::kAcceleration * std::cos(middle);
    EXPECT_NEAR(bin.force[0].mean, expected, bin.force[0].half_width + 1.0) << bin.low;
  }
  EXPECT_GT(profile.share[0], 0.6);
  EXPECT_EQ(profile.share[1], 0.0);
  EXPECT_THAT(missing.sentence, ::testing::StartsWith("a surge force that is "));
  EXPECT_THAT(missing.sentence, ::testing::HasSubstr("on headings of "));
  EXPECT_EQ(AdviseRecording(missing).manoeuvre, "eight headings");
}

TEST(MissingForce, OfANominalBoatRepeatsOverNothing) {
  const MissingForce missing = MissingOf({});
  for (const double excess : missing.excess) EXPECT_NEAR(excess, 0.0, 0.3);
  EXPECT_THAT(missing.sentence, ::testing::StartsWith("no force that repeats"));
  EXPECT_EQ(AdviseRecording(missing).manoeuvre, "drift and a straight course");
}

TEST(MissingForce, AlwaysComesWithARecordingThatWouldTell) {
  for (const ForceVariable variable : kForceVariables) {
    MissingForce missing;
    missing.excess = {0.0, 0.0, 2.0};
    ForceProfile& profile = missing.over.emplace_back();
    profile.variable = variable;
    profile.share = {0.0, 0.0, 0.5};
    profile.bins.resize(2);
    const SeparationAdvice advice = AdviseRecording(missing);
    EXPECT_FALSE(advice.manoeuvre.empty()) << Name(variable);
    EXPECT_FALSE(advice.how.empty()) << Name(variable);
    EXPECT_GT(advice.duration_s, 0.0) << Name(variable);
    EXPECT_TRUE(advice.separates.empty()) << Name(variable);
  }
}

}  // namespace
}  // namespace telltale
