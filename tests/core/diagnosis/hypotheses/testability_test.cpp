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
    return TestabilityOf(
        {short_.runs, nominal_, recording_, metric, parameter_refs_, no_excitation_}, model_,
        library_);
  }

  const testing::ShortRecording short_;
  const Eigen::Index rows_ = short_.runs.Rows();
  const Eigen::Index windows_ = static_cast<Eigen::Index>(short_.runs.Windows());
  const testing::InertEffect single_{"single", {{"size", "1", 1.0, -10.0, 10.0}}};
  const testing::InertEffect pair_{
      "pair", {{"first", "1", 1.0, -10.0, 10.0}, {"second", "1", 1.0, -10.0, 10.0}}};
  const std::vector<const Effect*> library_ = {&single_, &pair_};
  const std::vector<EffectParameterRef> parameter_refs_ = EffectParameterRefsOf(library_);
  const ObservedExcitation no_excitation_;
  UncertainModel model_ = [this] {
    UncertainModel model = short_.model;
    model.free = {{Equation::kYaw, 3}, {Equation::kYaw, 4}};
    model.covariance = Eigen::MatrixXd::Identity(2, 2);
    return model;
  }();
  NominalBaseline nominal_ = testing::UnitBaseline(rows_, 2, 3);
  Sensitivity recording_ =
      testing::SensitivityOfErrors(Eigen::MatrixXd::Zero(rows_, windows_), 2, 3);
};

TEST_F(TestabilityTest, IsTestableFromThreeSigmasOn) {
  recording_.by_effect_parameter.col(0) = Column(3, 3.1);
  auto testability = Assess();
  ASSERT_EQ(testability.size(), 2U);
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

}  // namespace
}  // namespace telltale
