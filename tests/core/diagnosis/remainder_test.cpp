#include "telltale/core/diagnosis/remainder.hpp"

#include <gtest/gtest.h>
#include <boost/random/normal_distribution.hpp>

#include "support/augmented_boats.hpp"
#include "telltale/core/random.hpp"

namespace telltale {
namespace {

/// A healthy boat's recording and, as the explanation, an effect of no size: what is held against
/// it is the test's to choose.
class RemainderTest : public ::testing::Test {
 protected:
  Remainder Left(const Eigen::MatrixXd& errors) const {
    return RemainderOf(explanation_, {errors, {}}, evidence_);
  }

  const UncertainModel model_ = UncertainModelOf(testing::KnownStableBoat()).value();
  const std::vector<Slot> slots_ = SlotsOf(EffectLibrary());
  const PreparedDataset sailed_ = testing::SailWithEffects({}, 300.0, 500);
  const FreeRuns runs_{sailed_, model_.model, 5.0};
  const Healthy healthy_ = LearnHealthy({runs_}, model_, slots_, 2);
  const Sensitivity recording_ = SensitivityOf(runs_, healthy_.boat, model_, slots_, 2);
  const Judge judge_{healthy_, recording_, EveryWindow(recording_), false};
  const Swings swings_{EffectLibrary(), runs_, healthy_.boat, recording_.errors, 2};
  const Evidence evidence_{runs_, healthy_, recording_, judge_, slots_, swings_};
  const EffectFit explanation_ = [] {
    EffectFit fit;
    fit.effects = {{FindEffect("thruster_lag"), {0.0}}};
    return fit;
  }();
};

TEST_F(RemainderTest, OfAHealthyBoatIsThatOfTheReferences) {
  const Remainder left = Left(recording_.errors);
  EXPECT_DOUBLE_EQ(left.before, left.after);
  EXPECT_LT(left.learnable, 0.05);
}

/// Half a typical size of one effect, whichever it is, left all along.
TEST_F(RemainderTest, IsLearnableWhereTheSameIsWrongEverywhere) {
  for (const char* effect : {"heading_bias", "thrust_gain", "antenna_lever_arm"}) {
    Eigen::MatrixXd errors = recording_.errors;
    for (std::size_t j = 0; j < slots_.size(); ++j) {
      if (slots_[j].effect != FindEffect(effect)) continue;
      errors.reshaped() += 0.5 * recording_.by_slot.col(static_cast<Eigen::Index>(j));
    }
    const Remainder left = Left(errors);
    EXPECT_GT(left.after, left.before) << effect;
    EXPECT_GT(left.learnable, 0.2) << effect;
  }
}

/// As much scatter again in every window, each for itself: nothing of one fold helps the other.
TEST_F(RemainderTest, IsNotLearnableOnARoughDay) {
  RandomEngine engine(5);
  boost::random::normal_distribution<double> normal;
  Eigen::MatrixXd errors = recording_.errors;
  const Eigen::MatrixXd root = healthy_.covariance.llt().matrixL();
  for (Eigen::Index w = 0; w < errors.cols(); ++w) {
    Eigen::VectorXd z(errors.rows());
    for (double& value : z) value = normal(engine);
    errors.col(w) += root * z;
  }
  const Remainder left = Left(errors);
  EXPECT_GT(left.after, 1.5 * left.before);
  EXPECT_LT(left.learnable, 0.05);
}

/// Half a minute, silence for as long, half a minute: each half is judged by the other.
TEST(Folds, AreBothThereHoweverARecordingIsTorn) {
  PreparedDataset torn = testing::SailWithEffects({}, 120.0, 500);
  const auto half_minute = static_cast<std::size_t>(30.0 / torn.sampling_period_s) + 1;
  const std::size_t first = torn.stretches.front().begin;
  torn.stretches = {{first, first + half_minute},
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
