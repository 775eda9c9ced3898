#include "telltale/core/diagnosis/hypotheses/lack_of_fit.hpp"

#include <gtest/gtest.h>
#include <boost/random/normal_distribution.hpp>

#include "support/stable_boat_with_effects.hpp"
#include "telltale/core/base/random.hpp"

namespace telltale {
namespace {

/// A nominal boat's recording and, as the explanation, an effect of no size: what is held against
/// it is the test's to choose.
class LackOfFitTest : public ::testing::Test {
 protected:
  LackOfFit Left(const Eigen::MatrixXd& errors) const {
    return AssessLackOfFit(explanation_, {errors, {}}, problem_);
  }

  const UncertainModel model_ = UncertainModelOf(testing::KnownStableBoat()).value();
  const std::vector<EffectParameterRef> parameter_refs_ = EffectParameterRefsOf(EffectLibrary());
  const PreparedDataset dataset_ = testing::SimulateWithEffects({}, 300.0, 500);
  const FreeRuns runs_{dataset_, model_.model, 5.0};
  const NominalBaseline nominal_ = LearnNominalBaseline({runs_}, model_, parameter_refs_, 2);
  const Sensitivity recording_ = SensitivityOf(runs_, nominal_.boat, model_, parameter_refs_, 2);
  const ResidualMetric metric_{nominal_, recording_, EveryWindow(recording_), false};
  const FrequencyResponse frequency_response_{EffectLibrary(), runs_, nominal_.boat,
                                              recording_.errors, 2};
  const DiagnosisProblem problem_{runs_,   nominal_,        recording_,
                                  metric_, parameter_refs_, frequency_response_};
  const EffectFit explanation_ = [] {
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

/// Half a typical size of one effect, whichever it is, left all along.
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

/// As much scatter again in every window, each for itself: nothing of one fold helps the other.
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

/// Half a minute, silence for as long, half a minute: each half is judged by the other.
TEST(Folds, AreBothNonEmptyDespiteGaps) {
  PreparedDataset torn = testing::SimulateWithEffects({}, 120.0, 500);
  const auto half_minute = static_cast<std::size_t>(30.0 / torn.sampling_period_s) + 1;
  const std::size_t first = torn.segments.front().begin;
  torn.segments = {{first, first + half_minute},
                   {first + 2 * half_minute, first + 3 * half_minute}};
  torn.commands.assign(2, torn.commands.front());
  torn.signals.assign(2, torn.signals.front());
  const UncertainModel model = UncertainModelOf(testing::KnownStableBoat()).value();
  const FreeRuns runs(torn, model.model, 5.0);
  const auto folds = FoldsOf(runs);
  for (std::size_t fold = 0; fold < kFolds; ++fold) EXPECT_GE(WindowsOf(folds, fold).size(), 5U);
}

}  // namespace
}  // namespace telltale
