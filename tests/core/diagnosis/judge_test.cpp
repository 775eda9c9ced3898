#include "diagnosis/judge.hpp"

#include <gtest/gtest.h>

#include "support/augmented_boats.hpp"

namespace telltale {
namespace {

struct JudgedBoat {
  UncertainModel model = UncertainModelOf(testing::KnownStableBoat()).value();
  std::vector<Slot> slots = SlotsOf(EffectLibrary());
  PreparedDataset sailed = testing::SailWithEffects({}, 120.0, 500);
  FreeRuns runs{sailed, model.model, 5.0};
  Healthy healthy = LearnHealthy({runs}, model, slots, 2);
  Sensitivity recording = SensitivityOf(runs, healthy.boat, model, slots, 2);
};

const JudgedBoat& Judged() {
  static const JudgedBoat boat;
  return boat;
}

Judge JudgeOf(bool free_base) {
  const JudgedBoat& boat = Judged();
  return {boat.healthy, boat.recording, EveryWindow(boat.recording), free_base};
}

TEST(Judge, RemembersWhetherItFreesTheBase) {
  EXPECT_FALSE(JudgeOf(false).FreesBase());
  EXPECT_TRUE(JudgeOf(true).FreesBase());
}

// What a coefficient that is as good as free would explain costs next to nothing; held to its
// covariance it costs what a prior asks: x'(I + v v')^-1 x = |x|^2 / (1 + |v|^2) for x along v.
TEST(Judge, ForgivesWhatAFreeCoefficientExplains) {
  const JudgedBoat& boat = Judged();
  const Eigen::VectorXd pattern = boat.recording.by_base.col(0) * 20.0;
  const auto cost = [&](const Judge& judge) {
    return judge.SeeColumns(pattern).col(0).dot(
        judge.Unexplained(judge.SeeColumns(pattern).col(0)));
  };
  EXPECT_LE(cost(JudgeOf(true)), 400.0 / (100.0 * 100.0) + 1e-6);  // 20 of 100 standard errors
  EXPECT_GT(cost(JudgeOf(false)), 10.0 * cost(JudgeOf(true)));
}

// Nothing weighed in can make an error count for more than it does by scatter alone.
TEST(Judge, NeverCountsMoreThanScatterAloneWould) {
  const JudgedBoat& boat = Judged();
  const Judge judge = JudgeOf(false);
  const Eigen::VectorXd seen = judge.See(boat.recording.errors);
  EXPECT_GE(judge.Square(seen), 0.0);
  EXPECT_LE(judge.Square(seen), seen.squaredNorm());
}

}  // namespace
}  // namespace telltale
