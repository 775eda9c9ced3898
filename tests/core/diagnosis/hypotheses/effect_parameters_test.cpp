#include "telltale/core/diagnosis/hypotheses/effect_parameters.hpp"

#include <gtest/gtest.h>

#include "support/hand_made_diagnosis.hpp"

namespace telltale {
namespace {

/// A size of 2 N and a shape of 1 +- 0.25.
const testing::InertEffect& SizeAndShape() {
  static const testing::InertEffect effect(
      "size_and_shape", {{"size", "N", 2.0, -8.0, 8.0}, {"shape", "1", 0.25, 0.5, 1.5, true, 1.0}});
  return effect;
}

TEST(EffectParameters, ScaleByTypicalSizeAboutThePriorMean) {
  const EffectParameters parameters({&SizeAndShape()});
  EXPECT_EQ(parameters.Scaled(Eigen::Vector2d(3.0, 1.25)), Eigen::Vector2d(1.5, 1.0));
}

TEST(EffectParameters, KeepValuesWithinTheirBounds) {
  const EffectParameters parameters({&SizeAndShape()});
  EXPECT_EQ(parameters.Scaled(Eigen::Vector2d(9.0, 0.0)), Eigen::Vector2d(4.0, -2.0));
  EXPECT_EQ(parameters.Clamped(Eigen::Vector2d(-5.0, 3.0)), Eigen::Vector2d(-4.0, 2.0));
}

TEST(EffectParameters, KeepTheFirstOfAnEffectWithinNarrowerBounds) {
  EffectParameters parameters({&SizeAndShape()});
  parameters.Bound(SizeAndShape(), -8.0, -1.0);
  EXPECT_EQ(parameters.Scaled(Eigen::Vector2d(9.0, 0.0)), Eigen::Vector2d(-0.5, -2.0));
  EXPECT_LT(parameters.DerivativeStep(0, -0.5), 0.0);  // away from the bound
}

TEST(EffectParameters, StackEffectsInOrder) {
  const testing::InertEffect first("first", {{"size", "1", 1.0, -9.0, 9.0}});
  const EffectParameters parameters({&first, &SizeAndShape()});
  const auto effects = parameters.Effects(Eigen::Vector3d(0.5, 1.0, -1.0));
  ASSERT_EQ(effects.size(), 2U);
  EXPECT_EQ(effects[0].effect, &first);
  EXPECT_EQ(effects[0].values, std::vector<double>{0.5});
  EXPECT_EQ(effects[1].values, (std::vector<double>{2.0, 0.75}));
}

// Standard deviations: two typical sizes, and one spread of a shape.
TEST(EffectParameters, HaveAWiderPriorForSizesThanForShapes) {
  const EffectParameters parameters({&SizeAndShape()});
  EXPECT_EQ(parameters.PriorInformation(), Eigen::Vector2d(0.25, 1.0));
}

TEST(EffectParameters, TakeDerivativesAwayFromTheUpperBound) {
  const EffectParameters parameters({&SizeAndShape()});
  EXPECT_GT(parameters.DerivativeStep(0, 0.0), 0.0);
  EXPECT_LT(parameters.DerivativeStep(0, 4.0), 0.0);
  EXPECT_GT(parameters.DerivativeStep(0, -4.0), 0.0);
}

}  // namespace
}  // namespace telltale
