#include "telltale/core/diagnosis/residuals/gap.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "support/stable_boat_with_effects.hpp"

namespace telltale {
namespace {

NoiseFloor NoiseFloorOfOne() {
  NoiseFloor floor;
  floor.scale = Eigen::VectorXd::Constant(6, 2.0);
  floor.log_gaps = {{0.0, 0.0, 0.0, 0.0}, {0.0, 0.0, 0.0, 0.0}};
  floor.spread = {0.1, 0.1, 0.1, 0.1};
  return floor;
}

TEST(SquaredGaps, AreMeanSquaresInNominalScales) {
  Eigen::MatrixXd errors = Eigen::MatrixXd::Zero(6, 2);
  errors.col(0) << 2.0, 0.0, 0.0, 4.0, 0.0, 0.0;  // along: 1 and 2 scales
  const NoiseFloor floor = NoiseFloorOfOne();
  EXPECT_DOUBLE_EQ(SquaredGaps(errors, floor.scale, 0)[0], 2.5);
  EXPECT_DOUBLE_EQ(SquaredGaps(errors, floor.scale, 1)[0], 0.0);
  EXPECT_DOUBLE_EQ(SquaredGaps(errors, floor.scale, kAllChannels)[0], 5.0 / 6.0);
  EXPECT_DOUBLE_EQ(SquaredGaps(errors, floor.scale, kAllChannels)[1], 0.0);
}

TEST(ExcessExplained, IsOneAtTheFloorAndZeroWhereNothingChanged) {
  const Eigen::VectorXd before = Eigen::VectorXd::Constant(40, 9.0);
  const Eigen::VectorXd floor_like = Eigen::VectorXd::Constant(40, 1.0);
  std::vector<std::size_t> blocks(40);
  for (std::size_t w = 0; w < blocks.size(); ++w) blocks[w] = w / 6;
  const NoiseFloor floor = NoiseFloorOfOne();
  const auto all = ExcessExplainedBy(before, floor_like, blocks, floor, kAllChannels, 1);
  ASSERT_TRUE(all.has_value());
  EXPECT_NEAR(all->share, 1.0, 1e-12);
  EXPECT_LE(all->interval.lower, 1.0);
  EXPECT_GE(all->interval.upper, 1.0);
  const auto none = ExcessExplainedBy(before, before, blocks, floor, kAllChannels, 1);
  ASSERT_TRUE(none.has_value());
  EXPECT_NEAR(none->share, 0.0, 1e-12);
}

TEST(ExcessExplained, IsUndefinedWhereThereIsNoGap) {
  const Eigen::VectorXd nominal = Eigen::VectorXd::Constant(40, 1.05);
  const std::vector<std::size_t> blocks(40, 0);
  EXPECT_FALSE(
      ExcessExplainedBy(nominal, nominal, blocks, NoiseFloorOfOne(), kAllChannels, 1).has_value());
}

// Student's t with two recordings taken as two degrees of freedom: 2.920 at 95 %.
TEST(NoiseFloor, LimitFollowsStudentsT) {
  EXPECT_NEAR(NoiseFloorOfOne().SquaredLimit(kAllChannels), std::exp(2.9200 * 0.1 * std::sqrt(1.5)),
              1e-4);
}

// ln G^2 of 0, 0.4 and 0.8 have a mean and a standard deviation of 0.4; Student's t with two
// degrees of freedom is 6.9646 at 99 %. Days that hardly differ are taken to differ by 0.2.
TEST(SquaredLimitOfDays, FollowsStudentsT) {
  EXPECT_NEAR(SquaredLimitOfDays({1.0, std::exp(0.4), std::exp(0.8)}),
              std::exp(0.4 + 6.96456 * 0.4 * std::sqrt(4.0 / 3.0)), 1e-3);
  EXPECT_NEAR(SquaredLimitOfDays({1.0, 1.0, 1.0}), std::exp(6.96456 * 0.2 * std::sqrt(4.0 / 3.0)),
              1e-3);
}

// A window's start is estimated, so a model that is the boat errs by sensor noise alone, and one
// that starts wrongly is forgiven.
TEST(FreeRuns, ErrByNoiseAloneWhereTheModelIsTheBoat) {
  const PreparedDataset dataset = testing::SimulateWithEffects({}, 120.0, 500);
  const FreeRuns runs(dataset, testing::StableBoat(), 5.0);
  ASSERT_GT(runs.Windows(), 15U);
  const Eigen::MatrixXd errors = runs.Errors({testing::StableBoat(), {}});
  // Two or three fixes of 1 cm a bin, 25 headings of 0.2 degrees, a fifth of the freedom spent on
  // the start; a third more for the grid of commands against that of simulation.
  for (Eigen::Index bin = 0; bin < 10; ++bin) {
    EXPECT_LT(std::sqrt(errors.row(3 * bin).squaredNorm() / static_cast<double>(errors.cols())),
              0.01);
    EXPECT_LT(std::sqrt(errors.row(3 * bin + 2).squaredNorm() / static_cast<double>(errors.cols())),
              0.0025);
  }
}

TEST(FreeRuns, ShowAFaultBeyondAnyStart) {
  const PreparedDataset weak =
      testing::SimulateWithEffects({{FindEffect("thruster_imbalance"), {0.3}}}, 120.0, 500);
  const FreeRuns runs(weak, testing::StableBoat(), 5.0);
  const Eigen::MatrixXd without = runs.Errors({testing::StableBoat(), {}});
  const Eigen::MatrixXd with =
      runs.Errors({testing::StableBoat(), {{FindEffect("thruster_imbalance"), {0.3}}}});
  EXPECT_GT(without.norm(), 5.0 * with.norm());
}

}  // namespace
}  // namespace telltale
