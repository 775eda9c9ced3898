#include "telltale/core/diagnosis/hypotheses/testability.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "support/hand_made_diagnosis.hpp"

namespace telltale {
namespace {

/// Effects whose sensitivity columns a test chooses, beside two coefficients of the yaw equation.
/// Every effect column lies along its own row of errors, at so many sigmas.
class TestabilityTest : public ::testing::Test {
 protected:
  /// A column along `row` that shows `sigmas`: its squared norm is sigmas^2 times the rows of an
  /// effective observation, which are 2 rows.
  Eigen::VectorXd Column(Eigen::Index row, double sigmas) const {
    Eigen::MatrixXd errors = Eigen::MatrixXd::Zero(rows_, windows_);
    errors.row(row).setConstant(
        sigmas * std::sqrt(2.0 * static_cast<double>(rows_) / static_cast<double>(windows_)));
    return errors.reshaped();
  }

  std::vector<EffectTestability> Assess() {
    recording_.by_coefficient.col(0) = Column(0, 1.0);
    recording_.by_coefficient.col(1) = Column(1, 1.0);
    const ResidualMetric metric(nominal_, recording_, EveryWindow(recording_), false);
    const DiagnosisProblem problem{short_.runs, nominal_,        recording_,
                                   metric,      parameter_refs_, no_excitation_};
    const WeatherBeside weather(hypothesis_, problem);
    std::vector<EffectTestability> all;
    for (const Effect* effect : library_) {
      all.push_back(TestabilityOf(*effect, problem, weather.Of(*effect), model_));
    }
    return all;
  }

  const testing::ShortRecording short_;
  const Eigen::Index rows_ = short_.runs.Rows();
  const Eigen::Index windows_ = static_cast<Eigen::Index>(short_.runs.Windows());
  const testing::InertEffect single_{"single", {{"size", "1", 1.0, -10.0, 10.0}}};
  const testing::InertEffect pair_{
      "pair", {{"first", "1", 1.0, -10.0, 10.0}, {"second", "1", 1.0, -10.0, 10.0}}};
  const testing::InertEffect breeze_{"breeze", {{"size", "1", 1.0, -10.0, 10.0}}, 0.0, {}, true};
  const std::vector<const Effect*> library_ = {&single_, &pair_, &breeze_};
  const std::vector<EffectParameterRef> parameter_refs_ = EffectParameterRefsOf(library_);
  const ObservedExcitation no_excitation_;
  UncertainModel model_ = [this] {
    UncertainModel model = short_.model;
    model.free = {{Equation::kYaw, 3}, {Equation::kYaw, 4}};
    model.covariance = Eigen::MatrixXd::Identity(2, 2);
    return model;
  }();
  NominalBaseline nominal_ = testing::UnitBaseline(rows_, 2, 4);
  Sensitivity recording_ =
      testing::SensitivityOfErrors(Eigen::MatrixXd::Zero(rows_, windows_), 2, 4);
  EffectFit hypothesis_ = [this] {
    EffectFit calm;
    calm.errors = recording_.errors;
    return calm;
  }();
};

TEST_F(TestabilityTest, IsTestableFromThreeSigmasOn) {
  recording_.by_effect_parameter.col(0) = Column(3, 3.1);
  auto testability = Assess();
  ASSERT_EQ(testability.size(), 3U);
  EXPECT_EQ(testability[0].effect, "single");
  EXPECT_EQ(testability[0].testability, Testability::kTestable);
  EXPECT_NEAR(testability[0].detectability, 3.1, 1e-9);
  EXPECT_EQ(testability[0].masked_by, "");

  recording_.by_effect_parameter.col(0) = Column(3, 2.9);
  testability = Assess();
  EXPECT_EQ(testability[0].testability, Testability::kNotExcited);
  EXPECT_NEAR(testability[0].detectability, 2.9, 1e-9);
}

TEST_F(TestabilityTest, OfSeveralParametersIsByTheirRootMeanSquare) {
  recording_.by_effect_parameter.col(1) = Column(3, 1.0);
  recording_.by_effect_parameter.col(2) = Column(4, 7.0);
  EXPECT_NEAR(Assess()[1].detectability, 5.0, 1e-9);
}

// The second coefficient is uncertain by one unit and moves errors along the same row: of the
// square s that the effect shows, s / (1 + |column|^2) is left.
TEST_F(TestabilityTest, IsMaskedByTheCoefficientThatImitatesIt) {
  nominal_.boat_covariance(1, 1) = 1.0;
  recording_.by_effect_parameter.col(0) = Column(1, 10.0);
  const EffectTestability testability = Assess()[0];
  EXPECT_EQ(testability.testability, Testability::kMasked);
  const double column_square = 2.0 * static_cast<double>(rows_);
  EXPECT_NEAR(testability.detectability, 10.0 / std::sqrt(1.0 + column_square), 1e-9);
  EXPECT_EQ(testability.masked_by,
            "YAW " + std::string(Regressors(Equation::kYaw, Parameterization::kPropeller)[4].name));
}

// Of the square s that the effect shows, s / (1 + 4 c) is left where the weather's typical size
// shows the square c along the same row, with a prior as wide as twice that size.
TEST_F(TestabilityTest, IsMaskedByTheWeatherThatImitatesIt) {
  recording_.by_effect_parameter.col(0) = Column(3, 10.0);
  recording_.by_effect_parameter.col(1) = Column(4, 5.0);
  recording_.by_effect_parameter.col(3) = Column(3, 4.0);
  hypothesis_.effects = {{&breeze_, {1.0}}};
  const auto testability = Assess();
  EXPECT_NEAR(testability[0].detectability, 10.0 / std::sqrt(1.0 + 4.0 * 16.0), 1e-9);
  EXPECT_EQ(testability[0].testability, Testability::kMasked);
  EXPECT_EQ(testability[0].masked_by, "breeze");
  EXPECT_NEAR(testability[1].detectability, 5.0 / std::sqrt(2.0), 1e-9) << "of another row";
  EXPECT_NEAR(testability[2].detectability, 4.0, 1e-9) << "the weather itself";
}

// Waves that scatter errors three times as much as a nominal boat's leave a half of each sigma.
TEST_F(TestabilityTest, ShowsByLessInWaves) {
  const Effect* waves = FindEffect("waves");
  recording_.by_effect_parameter.col(0) = Column(3, 10.0);
  hypothesis_.effects = {{waves, {1.0, 1.0, 1.0, 2.0}}};
  hypothesis_.scatter = 3.0 * Eigen::MatrixXd::Identity(rows_, rows_);
  EXPECT_NEAR(Assess()[0].detectability, 5.0, 1e-9);
}

}  // namespace
}  // namespace telltale
