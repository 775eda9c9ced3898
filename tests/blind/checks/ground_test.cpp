#include "ground/ground.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/augmented_boats.hpp"

namespace blind {
namespace {

using telltale::FindEffect;
using telltale::ModelledEffect;

Days WeakenedOnAnotherDay() {
  constexpr double kDurationS = 200.0;
  Days days{.model = telltale::UncertainModelOf(telltale::testing::KnownStableBoat()).value(),
            .recording = telltale::testing::SailWithEffects({{FindEffect("thrust_gain"), {0.3}}},
                                                            kDurationS, 9100),
            .references = {}};
  for (const std::uint64_t seed : {1300, 1400}) {
    days.references.push_back(telltale::testing::SailWithEffects({}, kDurationS, seed));
  }
  return days;
}

TEST(Ground, MeasuresHowFarAModelClosesTheGap) {
  const Days days = WeakenedOnAnotherDay();
  const Ground ground(days);
  const auto closure = [&](double loss) {
    return ground.ClosureBy(ground.With({{FindEffect("thrust_gain"), {loss}}})).value();
  };
  EXPECT_NEAR(ground.ClosureBy(ground.healthy.boat).value(), 0.0, 1e-12);
  EXPECT_NEAR(closure(0.3), 1.0, 0.05);  // the truth; healthy days differ by their noise
  // Errors of the thrust itself go with what is missing of it, so half of it leaves a quarter.
  EXPECT_NEAR(closure(0.15), 0.75, 0.08);
  EXPECT_LT(closure(-0.3), 0.0) << "the wrong way";
}

TEST(Ground, KnowsNoClosureWhereThereIsNoGap) {
  Days days = WeakenedOnAnotherDay();
  days.recording = telltale::testing::SailWithEffects({}, 200.0, 9200);
  const Ground ground(days);
  EXPECT_FALSE(ground.ClosureBy(ground.healthy.boat).has_value());
}

}  // namespace
}  // namespace blind
