#include "telltale/core/diagnosis/hypotheses/lack_of_fit.hpp"

#include <gtest/gtest.h>
#include <boost/random/normal_distribution.hpp>

#include "support/hand_made_diagnosis.hpp"
#include "support/stable_boat_with_effects.hpp"
#include "telltale/core/base/random.hpp"

namespace telltale {
namespace {

/// A nominal boat's recording and, as the hypothesis, an effect of size zero. Tests choose its
/// cross-validated errors.
class LackOfFitTest : public ::testing::Test {
 protected:
  LackOfFit Left(const Eigen::MatrixXd& errors) const {
    return AssessLackOfFit(hypothesis_, {errors, {}}, problem_);
  }

  const UncertainModel model_ = UncertainModelOf(testing::KnownStableBoat()).value();
  const std::vector<EffectParameterRef> parameter_refs_ = EffectParameterRefsOf(EffectLibrary());
  const PreparedDataset dataset_ = testing::SimulateWithEffects({}, 300.0, 500);
  const FreeRuns runs_{dataset_, model_.model, 5.0};
  const NominalBaseline nominal_ =
      LearnNominalBaseline(testing::RunsOf(dataset_, model_.model), model_, parameter_refs_, 2);
  const Sensitivity recording_ =
      SensitivityOf(runs_, {nominal_.boat, nominal_.coefficients}, model_, parameter_refs_, 2);
  const ResidualMetric metric_{nominal_, recording_, EveryWindow(recording_), false};
  const ObservedExcitation no_excitation_;
  const DiagnosisProblem problem_{runs_,   nominal_,        recording_,
                                  metric_, parameter_refs_, no_excitation_};
  const EffectFit hypothesis_ = [] {
    EffectFit fit;
    fit.effects = {{FindEffect("thruster_lag"), {0.0}}};
    return fit;
  }();
};

TEST_F(LackOfFitTest, OfANominalBoatIsThatOfTheReferences) {
  const LackOfFit left = Left(recording_.errors);
  EXPECT_DOUBLE_EQ(left.before, left.after);
  EXPECT_LT(left.predictable, 0.05);
}

/// One window of ten errs ten times as much.
TEST_F(LackOfFitTest, FewBadWindowsLeaveTheMedian) {
  Eigen::MatrixXd errors = recording_.errors;
  for (Eigen::Index w = 0; w < errors.cols(); w += 10) errors.col(w) *= 10.0;
  const LackOfFit nominal = Left(recording_.errors);
  const LackOfFit left = Left(errors);
  EXPECT_GT(left.after, 3.0 * nominal.after);
  EXPECT_LT(left.median, 2.0 * nominal.median);
}

/// Half a typical size of one effect, left throughout the recording.
TEST_F(LackOfFitTest, IsPredictableWhereTheErrorIsTheSameEverywhere) {
  for (const char* effect : {"heading_bias", "thrust_gain", "antenna_lever_arm"}) {
    Eigen::MatrixXd errors = recording_.errors;
    for (std::size_t j = 0; j < parameter_refs_.size(); ++j) {
      if (parameter_refs_[j].effect != FindEffect(effect)) continue;
      errors.reshaped() += 0.5 * recording_.by_effect_parameter.col(static_cast<Eigen::Index>(j));
    }
    const LackOfFit left = Left(errors);
    EXPECT_GT(left.after, left.before) << effect;
    EXPECT_GT(left.predictable, 0.2) << effect;
  }
}

/// Twice the variance, drawn independently in every window: no fold predicts the other.
TEST_F(LackOfFitTest, IsNotPredictableWhereOnlyScatterGrows) {
  RandomEngine engine(5);
  boost::random::normal_distribution<double> normal;
  Eigen::MatrixXd errors = recording_.errors;
  const Eigen::MatrixXd root = nominal_.covariance.llt().matrixL();
  for (Eigen::Index w = 0; w < errors.cols(); ++w) {
    Eigen::VectorXd z(errors.rows());
    for (double& value : z) value = normal(engine);
    errors.col(w) += root * z;
  }
  const LackOfFit left = Left(errors);
  EXPECT_GT(left.after, 1.5 * left.before);
  EXPECT_LT(left.predictable, 0.05);
}

}  // namespace
}  // namespace telltale
