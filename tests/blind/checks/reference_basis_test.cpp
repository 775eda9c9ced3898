#include "inputs/reference_basis.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/stable_boat_with_effects.hpp"

namespace blind {
namespace {

using telltale::FindEffect;
using telltale::ModelledEffect;

DiagnosisInputs WeakenedOnAnotherDay() {
  constexpr double kDurationS = 200.0;
  DiagnosisInputs inputs{
      .model = telltale::UncertainModelOf(telltale::testing::KnownStableBoat()).value(),
      .recording = telltale::testing::SimulateWithEffects({{FindEffect("thrust_gain"), {0.3}}},
                                                          kDurationS, 9100),
      .references = {}};
  for (const std::uint64_t seed : {1300, 1400}) {
    inputs.references.push_back(telltale::testing::SimulateWithEffects({}, kDurationS, seed));
  }
  return inputs;
}

TEST(ReferenceBasis, MeasuresHowMuchOfTheExcessAModelExplains) {
  const DiagnosisInputs inputs = WeakenedOnAnotherDay();
  const ReferenceBasis basis(inputs);
  const auto closure = [&](double loss) {
    return basis.ClosureBy(basis.With({{FindEffect("thrust_gain"), {loss}}})).value();
  };
  EXPECT_NEAR(basis.ClosureBy(basis.nominal.boat).value(), 0.0, 1e-12);
  EXPECT_NEAR(closure(0.3), 1.0, 0.05);  // the truth; nominal days differ by their noise
  // Errors of the thrust itself go with what is missing of it, so half of it leaves a quarter.
  EXPECT_NEAR(closure(0.15), 0.75, 0.08);
  EXPECT_LT(closure(-0.3), 0.0) << "the wrong way";
}

TEST(ReferenceBasis, KnowsNoClosureWhereThereIsNoGap) {
  DiagnosisInputs inputs = WeakenedOnAnotherDay();
  inputs.recording = telltale::testing::SimulateWithEffects({}, 200.0, 9200);
  const ReferenceBasis basis(inputs);
  EXPECT_FALSE(basis.ClosureBy(basis.nominal.boat).has_value());
}

}  // namespace
}  // namespace blind
