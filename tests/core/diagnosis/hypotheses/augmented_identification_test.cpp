#include "telltale/core/diagnosis/hypotheses/augmented_identification.hpp"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/hand_made_diagnosis.hpp"
#include "support/physical_boat.hpp"

namespace telltale {
namespace {

/// One free coefficient, the third of surge, whose change of one standard error moves errors by a
/// known pattern. The references leave it a variance of 0.5 standard errors squared.
class ReidentificationTest : public ::testing::Test {
 protected:
  static constexpr std::size_t kFree = 2;
  static constexpr double kVariance = 0.5;

  const testing::ShortRecording short_;
  const Identification old_ = testing::KnownStableBoat();
  const UncertainModel model_ = [this] {
    UncertainModel model = short_.model;
    model.free = {{Equation::kSurge, kFree}};
    model.covariance =
        Eigen::MatrixXd::Constant(1, 1, std::pow(old_.coefficients[kFree].standard_error, 2));
    return model;
  }();
  const NominalBaseline nominal_ = [this] {
    NominalBaseline nominal = testing::UnitBaseline(short_.runs.Rows(), 1, 0);
    nominal.boat_covariance(0, 0) = kVariance;
    return nominal;
  }();
  const Eigen::MatrixXd pattern_ =
      testing::Pattern(short_.runs.Rows(), static_cast<Eigen::Index>(short_.runs.Windows()), 0.7);
  const Sensitivity recording_ = [this] {
    Sensitivity recording = testing::SensitivityOfErrors(-1.5 * pattern_, 1, 0);
    recording.by_coefficient.col(0) = pattern_.reshaped();
    return recording;
  }();
  const ResidualMetric metric_{nominal_, recording_, EveryWindow(recording_), false};
  const std::vector<EffectParameterRef> no_parameters_;
  const ObservedExcitation no_excitation_;
  const DiagnosisProblem problem_{short_.runs, nominal_,       recording_,
                                  metric_,     no_parameters_, no_excitation_};
  const EffectFit fit_ = [this] {
    EffectFit fit;
    fit.effects = {{FindEffect("thruster_lag"), {0.15}}};
    fit.errors = recording_.errors;
    return fit;
  }();

  // Errors -1.5 p + x p with x ~ N(0, C): mean 1.5 C p'p / (1 + C p'p), variance C / (1 + C p'p).
  const double information_ = kVariance * pattern_.squaredNorm();
  const double change_ = 1.5 * information_ / (1.0 + information_);
  const double sd_ = std::sqrt(kVariance / (1.0 + information_));
};

TEST_F(ReidentificationTest, MovesTheFreeCoefficientToItsPosteriorMean) {
  const AugmentedModel boat = Reidentified(fit_, problem_, model_);
  VesselModel expected = testing::StableBoat();
  expected.theta[0][kFree] += change_ * old_.coefficients[kFree].standard_error;
  for (std::size_t equation = 0; equation < 3; ++equation) {
    EXPECT_TRUE(boat.model.theta[equation].isApprox(expected.theta[equation], 1e-9)) << equation;
  }
  ASSERT_EQ(boat.effects.size(), 1U);
  EXPECT_EQ(boat.effects[0].effect, FindEffect("thruster_lag"));
}

TEST_F(ReidentificationTest, GivesTheFreeCoefficientItsPosteriorBounds) {
  const AugmentedModel boat = Reidentified(fit_, problem_, model_);
  const Identification augmented = Augmented(old_, boat, fit_, problem_, model_);
  const Coefficient& before = old_.coefficients[kFree];
  const Coefficient& after = augmented.coefficients[kFree];
  EXPECT_NEAR(after.estimate, before.estimate + change_ * before.standard_error, 1e-9);
  EXPECT_NEAR(after.standard_error, sd_ * before.standard_error, 1e-12);
  EXPECT_NEAR(after.interval.upper - after.interval.lower, 2.0 * 1.96 * after.standard_error,
              1e-4 * after.standard_error);
  EXPECT_NEAR(augmented.covariance(kFree, kFree), std::pow(after.standard_error, 2), 1e-15);
}

TEST_F(ReidentificationTest, LeavesCoefficientsThatAreNotFree) {
  const AugmentedModel boat = Reidentified(fit_, problem_, model_);
  const Identification augmented = Augmented(old_, boat, fit_, problem_, model_);
  for (std::size_t i = 0; i < old_.coefficients.size(); ++i) {
    if (i == kFree) continue;
    EXPECT_EQ(augmented.coefficients[i].estimate, old_.coefficients[i].estimate) << i;
    EXPECT_EQ(augmented.coefficients[i].standard_error, old_.coefficients[i].standard_error) << i;
  }
}

TEST_F(ReidentificationTest, NamesTheEffectsAndDropsTheOldSimulationParameters) {
  Identification with_simulation = old_;
  for (const Coefficient& c : old_.coefficients) with_simulation.simulation.push_back(c.estimate);
  const AugmentedModel boat = Reidentified(fit_, problem_, model_);
  const Identification augmented = Augmented(with_simulation, boat, fit_, problem_, model_);
  EXPECT_TRUE(augmented.simulation.empty());
  ASSERT_EQ(augmented.effects.size(), 1U);
  EXPECT_EQ(augmented.effects[0].effect, "thruster_lag");
  EXPECT_EQ(augmented.effects[0].values, std::vector<double>{0.15});

  const auto model = AugmentedModelOf(augmented);
  ASSERT_TRUE(model.has_value());
  EXPECT_EQ(model->effects[0].effect, FindEffect("thruster_lag"));
}

/// The same with one free physical parameter.
class PhysicalReidentificationTest : public ReidentificationTest {
 protected:
  static constexpr Eigen::Index kNr = At(FossenParameter::kNr);

  const Identification physical_ = testing::KnownPhysicalBoat(testing::PhysicalBoat(), 0.1);
  const UncertainModel uncertain_ = [this] {
    UncertainModel model = UncertainModelOf(physical_).value();
    model.free = {{Equation::kUnknown, kNr}};
    model.covariance = physical_.physical->covariance(std::vector{kNr}, std::vector{kNr});
    return model;
  }();
};

TEST_F(PhysicalReidentificationTest, MovesTheParameterAndTheCoefficientsThatItImplies) {
  const AugmentedModel boat = Reidentified(fit_, problem_, uncertain_);
  const Identification augmented = Augmented(physical_, boat, fit_, problem_, uncertain_);
  const Coefficient& before = physical_.physical->parameters[kNr];
  const Coefficient& after = augmented.physical->parameters[kNr];
  EXPECT_NEAR(after.estimate, before.estimate + change_ * before.standard_error, 1e-9);
  EXPECT_NEAR(after.standard_error, sd_ * before.standard_error, 1e-12);
  const Eigen::VectorXd implied =
      CoefficientsOf(augmented.physical->Estimates(), testing::kPhysicalBoatSeparation);
  EXPECT_LT((augmented.Estimates() - implied.head(implied.size() - 1)).norm(), 1e-12);
  EXPECT_TRUE(boat.model.theta[2].isApprox(ModelOf(augmented)->theta[2], 1e-12));
}

// Nr alone is uncertain, and the damping in yaw of the coefficients is Nr times an element of the
// inverse of M.
TEST_F(PhysicalReidentificationTest, BoundsTheCoefficientsByWhatTheyDependOn) {
  const AugmentedModel boat = Reidentified(fit_, problem_, uncertain_);
  const Identification augmented = Augmented(physical_, boat, fit_, problem_, uncertain_);
  for (const Coefficient& coefficient : augmented.coefficients) {
    const bool depends = coefficient.regressor == "r" && coefficient.estimate != 0.0;
    EXPECT_EQ(coefficient.standard_error > 0.0, depends) << coefficient.symbol;
  }
  const Eigen::Matrix2d mass{{1.5, 0.03}, {0.03, 0.18}};  // of the physical boat
  const Coefficient& damping = augmented.coefficients[9 + 13 + 7];
  EXPECT_NEAR(damping.standard_error,
              mass.inverse()(1, 1) * augmented.physical->parameters[kNr].standard_error, 1e-9);
}

TEST(AugmentedModelOf, RefusesAnEffectThatTheLibraryLacks) {
  Identification identification = testing::KnownStableBoat();
  identification.effects = {{"magnetism", {1.0}}};
  const auto model = AugmentedModelOf(identification);
  ASSERT_FALSE(model.has_value());
  EXPECT_THAT(model.error().reason, ::testing::HasSubstr("magnetism"));
}

}  // namespace
}  // namespace telltale
