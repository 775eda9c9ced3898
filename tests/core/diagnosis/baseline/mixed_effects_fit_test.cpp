#include "telltale/core/diagnosis/baseline/mixed_effects_fit.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "support/hand_made_diagnosis.hpp"

namespace telltale {
namespace {

constexpr Eigen::Index kRows = 3;
constexpr Eigen::Index kWindows = 60;
constexpr double kNoise = 1e-3;
constexpr std::size_t kDays = 4;

/// Days whose errors are linear in a coefficient, a fixed effect and a weather of known sizes.
class MixedEffectsFitTest : public ::testing::Test {
 protected:
  MixedEffectsFitTest() {
    const Eigen::Index coefficients = std::ssize(model_.free);
    for (std::size_t day = 0; day < kDays; ++day) {
      const double frequency = 0.7 + 0.11 * static_cast<double>(day);
      const Eigen::MatrixXd noise = kNoise * testing::Pattern(kRows, kWindows, 3.0 * frequency);
      Sensitivity recording =
          testing::SensitivityOfErrors(noise, coefficients, std::ssize(parameter_refs_));
      recording.by_coefficient.col(1) = Column(1.1 * frequency);
      recording.by_effect_parameter =
          testing::Pattern(kRows * kWindows, std::ssize(parameter_refs_), 0.37 * frequency);
      recording.errors -= Reshaped(kCoefficient * recording.by_coefficient.col(1) +
                                   kFixed * recording.by_effect_parameter.col(Fixed()) +
                                   weather_[day] * recording.by_effect_parameter.col(Weather()));
      noise_.push_back(noise);
      recordings_.push_back(recording);
    }
    fit_.Accumulate(recordings_, factor_, 1.0);
    fit_.Solve();
  }

  static Eigen::VectorXd Column(double frequency) {
    return testing::Pattern(kRows * kWindows, 1, frequency);
  }
  static Eigen::MatrixXd Reshaped(const Eigen::VectorXd& stacked) {
    return stacked.reshaped(kRows, kWindows);
  }
  Eigen::Index Fixed() const { return variations_.fixed.front(); }
  Eigen::Index Weather() const { return variations_.weather.front(); }

  static constexpr double kCoefficient = 2.0;
  static constexpr double kFixed = 0.4;
  const std::vector<double> weather_ = {0.5, -0.3, 0.2, -0.6};
  const UncertainModel model_ = UncertainModelOf(testing::KnownStableBoat()).value();
  const std::vector<const Effect*> library_ = {FindEffect("hull_fouling"), FindEffect("wind"),
                                               FindEffect("heading_bias")};
  const std::vector<EffectParameterRef> parameter_refs_ = EffectParameterRefsOf(library_);
  const NominalVariations variations_ = NominalVariationsOf(parameter_refs_);
  const Eigen::LLT<Eigen::MatrixXd> factor_{kNoise * kNoise *
                                            Eigen::MatrixXd::Identity(kRows, kRows)};
  std::vector<Sensitivity> recordings_;
  std::vector<Eigen::MatrixXd> noise_;
  MixedEffectsFit fit_{model_, parameter_refs_, kDays};
};

TEST_F(MixedEffectsFitTest, FindsTheChangesOfTheBoat) {
  fit_.Accept(1.0);
  EXPECT_NEAR(fit_.Coefficients()[1], kCoefficient, 0.01);
  EXPECT_NEAR(fit_.FixedEffects()[Fixed()], kFixed, 0.01);
}

TEST_F(MixedEffectsFitTest, MakesAShareOfTheChange) {
  fit_.Accept(0.25);
  EXPECT_NEAR(fit_.Coefficients()[1], 0.25 * kCoefficient, 0.01);
  EXPECT_NEAR(fit_.FixedEffects()[Fixed()], 0.25 * kFixed, 0.01);
}

// Four sizes and the prior's one of 0.1: by (85).
TEST_F(MixedEffectsFitTest, EstimatesTheScatterOfTheWeather) {
  double squares = 0.1 * 0.1;
  for (const double size : weather_) squares += size * size;
  EXPECT_NEAR(fit_.WeatherSd()[Weather()], std::sqrt(squares / (kDays + 1.0)), 0.01);
}

TEST_F(MixedEffectsFitTest, PredictsTheNoiseAloneToBeLeft) {
  for (std::size_t day = 0; day < kDays; ++day) {
    EXPECT_LT((fit_.PredictedResiduals(recordings_[day], day) - noise_[day]).norm(),
              0.5 * noise_[day].norm());
  }
}

// The errors of a boat that is right, on days of weather.
TEST_F(MixedEffectsFitTest, TakesTheWeatherOfABoatAway) {
  for (std::size_t day = 0; day < kDays; ++day) {
    const Sensitivity& recording = recordings_[day];
    const Eigen::MatrixXd errors =
        noise_[day] - Reshaped(weather_[day] * recording.by_effect_parameter.col(Weather()));
    EXPECT_LT((fit_.LessWeather(errors, recording, factor_, 1.0) - noise_[day]).norm(),
              0.5 * noise_[day].norm());
  }
}

// A fouled hull is in the coefficients, and wind is no property of the boat.
TEST_F(MixedEffectsFitTest, KnowsWhatANominalBoatDoesNotHave) {
  fit_.Accept(1.0);
  const Eigen::MatrixXd covariance = fit_.BoatCovariance();
  const Eigen::Index coefficients = std::ssize(model_.free);
  for (const Effect* effect : {FindEffect("hull_fouling"), FindEffect("wind")}) {
    for (const Eigen::Index j : ColumnsOf(*effect, parameter_refs_)) {
      EXPECT_EQ(fit_.FixedEffects()[j], 0.0);
      EXPECT_TRUE(covariance.row(coefficients + j).isZero(0.0));
      EXPECT_TRUE(covariance.col(coefficients + j).isZero(0.0));
    }
  }
  EXPECT_GT(covariance(coefficients + Fixed(), coefficients + Fixed()), 0.0);
  EXPECT_GT(covariance(1, 1), 0.0);
}

}  // namespace
}  // namespace telltale
