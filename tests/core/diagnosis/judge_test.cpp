#include "telltale/core/diagnosis/judge.hpp"

#include <cmath>

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

// Sherman and Morrison: y' (V + b b' / kappa)^-1 y = y' V^-1 y - (y' V^-1 b)^2 / (kappa + b' V^-1
// b), and the determinant grows by 1 + b' V^-1 b with scatter alone.
TEST(Judge, AllowsForWhatVariesInAWindow) {
  const JudgedBoat& boat = Judged();
  const Judge judge(boat.healthy, boat.recording, {3}, false);
  const Eigen::VectorXd varying = 4.0 * boat.recording.by_slot.col(0);
  const Judge allowing = judge.Allowing(varying);
  const Eigen::VectorXd y = judge.See(boat.recording.errors);
  const Eigen::VectorXd b = judge.SeeColumns(varying).col(0);
  const double by = b.dot(judge.Unexplained(y));
  const double bb = b.dot(judge.Unexplained(b));
  EXPECT_GT(bb, 1.0);  // or there would be nothing to allow for
  EXPECT_NEAR(allowing.Square(allowing.See(boat.recording.errors)),
              judge.Square(y) - by * by / (judge.Kappa() + bb), 1e-9 * judge.Square(y));
  EXPECT_NEAR(allowing.Allowance(),
              judge.Kappa() * std::log1p(b.squaredNorm() / judge.Kappa()) / judge.RowsALook(),
              1e-12);
}

// A ratio of likelihoods: nothing to tell between equals, and what is gained step by step adds up.
TEST(Judge, WeighsEvidenceByRatiosOfSquares) {
  const Judge judge = JudgeOf(false);
  EXPECT_EQ(judge.Evidence(7.0, 7.0), 0.0);
  EXPECT_LT(judge.Evidence(5.0, 7.0), 0.0);
  EXPECT_NEAR(judge.Evidence(2.0, 5.0) + judge.Evidence(5.0, 7.0), judge.Evidence(2.0, 7.0), 1e-12);
}

// A model three standard errors off in every coefficient, and references by the boat itself.
TEST(Healthy, RecalibratesAModelThatIsOff) {
  UncertainModel off = UncertainModelOf(testing::KnownStableBoat()).value();
  Eigen::VectorXd change = 3.0 * off.StandardErrors();
  for (Eigen::Index i = 0; i < change.size(); i += 2) change[i] = -change[i];
  off.model = off.Changed(off.model, change);
  std::vector<PreparedDataset> days;
  for (const std::uint64_t seed : {21, 22, 23}) {
    days.push_back(testing::SailWithEffects({}, 240.0, 100 * seed));
  }
  std::vector<FreeRuns> runs;
  for (const PreparedDataset& day : days) runs.emplace_back(day, off.model, 5.0);
  const Healthy healthy = LearnHealthy(runs, off, SlotsOf(EffectLibrary()), 2);
  const PreparedDataset another = testing::SailWithEffects({}, 240.0, 3100);
  const FreeRuns sailed(another, off.model, 5.0);
  const double truth = sailed.Errors({testing::StableBoat(), {}}).squaredNorm();
  const double before = sailed.Errors({off.model, {}}).squaredNorm();
  const double after = sailed.Errors(healthy.boat).squaredNorm();
  EXPECT_GT(before, 10.0 * truth);  // or there would be nothing to mend
  // Thirty coefficients from three recordings as long as this one cost a share of its noise.
  EXPECT_LT(after, 1.5 * truth);
}

}  // namespace
}  // namespace telltale
