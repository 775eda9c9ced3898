#include "telltale/core/diagnosis/residuals/sensitivity.hpp"

#include <gtest/gtest.h>

#include "support/hand_made_diagnosis.hpp"
#include "support/resting_boat.hpp"

namespace telltale {
namespace {

constexpr Eigen::Index kConstantTerm = 4;  // of surge's regressors u|u|, vr, rr, u, 1
constexpr double kStandardError = 0.02;

/// The resting boat, of whose coefficients the constant acceleration in surge alone is uncertain.
UncertainModel UncertainInSurge(const VesselModel& model) {
  return {model,
          {{Equation::kSurge, kConstantTerm}},
          Eigen::MatrixXd::Constant(1, 1, kStandardError * kStandardError),
          std::nullopt};
}

class SensitivityOfTheRestingBoat : public ::testing::Test {
 protected:
  /// What an acceleration of 1 m/s^2 ahead changes of the errors, measured less predicted: -t^2 / 2
  /// along.
  Eigen::VectorXd PushedAhead() const {
    Eigen::MatrixXd errors =
        Eigen::MatrixXd::Zero(boat_.runs.Rows(), static_cast<Eigen::Index>(boat_.runs.Windows()));
    for (std::size_t window = 0; window < boat_.runs.Windows(); ++window) {
      errors(Eigen::seq(0, Eigen::last, 3), static_cast<Eigen::Index>(window)) =
          boat_.LeftByTheStart(window, 0, [](double t) { return -0.5 * t * t; });
    }
    return errors.reshaped();
  }

  Sensitivity About(const AugmentedModel& model, double step = 1.0) const {
    return SensitivityOf(boat_.runs, {model, Eigen::VectorXd::Zero(1)},
                         UncertainInSurge(boat_.model), {{body_bias_, 0}}, 1, step);
  }

  const Effect* body_bias_ = FindEffect("body_bias");
  double typical_ = FindEffect("body_bias")->Parameters()[0].typical;
  testing::RestingBoat boat_;
};

TEST_F(SensitivityOfTheRestingBoat, IsTheChangeByOneStandardErrorOfACoefficient) {
  const Sensitivity found = About({boat_.model, {}});
  const Eigen::VectorXd expected = kStandardError * PushedAhead();
  ASSERT_EQ(found.by_coefficient.cols(), 1);
  EXPECT_LT((found.by_coefficient.col(0) - expected).norm(), 2e-3 * expected.norm());
}

TEST_F(SensitivityOfTheRestingBoat, IsTheChangeByOneTypicalSizeOfAParameter) {
  const Eigen::VectorXd expected = typical_ * PushedAhead();
  for (const double step : {1.0, 0.1}) {
    const Sensitivity found = About({boat_.model, {}}, step);
    ASSERT_EQ(found.by_effect_parameter.cols(), 1);
    EXPECT_LT((found.by_effect_parameter.col(0) - expected).norm(), 2e-3 * expected.norm());
  }
}

// A boat that has the effect already errs by it, and by as much more with more of it.
TEST_F(SensitivityOfTheRestingBoat, AddsToWhatTheBoatHas) {
  constexpr double kHeld = 0.03;
  const Sensitivity found = About({boat_.model, {{body_bias_, {kHeld, 0.0, 0.0}}}});
  const Eigen::VectorXd pushed = PushedAhead();
  EXPECT_LT((found.errors.reshaped() - kHeld * pushed).norm(), 2e-3 * kHeld * pushed.norm());
  EXPECT_LT((found.by_effect_parameter.col(0) - typical_ * pushed).norm(),
            2e-3 * typical_ * pushed.norm());
}

TEST(EffectParameterRefs, AreThoseThatMoveFreeRunsAndDoNotShape) {
  const testing::InertEffect shaped(
      "shaped", {{"size", "m", 0.5, -1.0, 1.0}, {"ratio", "1", 0.3, 0.0, 1.0, true, 0.7}});
  const auto refs = EffectParameterRefsOf(std::vector<const Effect*>{&shaped, FindEffect("waves")});
  ASSERT_EQ(refs.size(), 1U);
  EXPECT_EQ(refs[0].effect, &shaped);
  EXPECT_EQ(refs[0].parameter, 0U);
  EXPECT_EQ(At(refs[0], 0.2).values, (std::vector{0.2, 0.7}));  // the ratio at its prior mean
}

TEST(EffectsOf, TakesSizesInTypicalSizesAndLeavesOutWhatIsNone) {
  const Effect* const bias = FindEffect("body_bias");
  const testing::InertEffect other("other", {{"size", "m", 0.5, -1.0, 1.0}});
  const std::vector<EffectParameterRef> refs = {{bias, 0}, {bias, 1}, {bias, 2}, {&other, 0}};
  const auto effects = EffectsOf(refs, Eigen::Vector4d(2.0, 0.0, -1.0, 0.0));
  ASSERT_EQ(effects.size(), 1U);
  const auto parameters = bias->Parameters();
  EXPECT_EQ(effects[0].values,
            (std::vector{2.0 * parameters[0].typical, 0.0, -parameters[2].typical}));
}

}  // namespace
}  // namespace telltale
