#include "telltale/core/uncertainty/live_bounds.hpp"

#include <algorithm>

#include <gtest/gtest.h>
#include <boost/random/normal_distribution.hpp>

#include "support/discrete_boat.hpp"
#include "telltale/core/base/contract.hpp"
#include "telltale/core/estimation/regression/one_step.hpp"
#include "telltale/core/paper/yellowfish.hpp"

namespace telltale {
namespace {

constexpr std::size_t kRows = 3000;

/// A noisy boat with a gap after row 1200 and astern, where no equation looks, in between.
PreparedDataset NoisyBoat() {
  const auto commands = testing::RandomCommands(
      kRows,
      {PropellerRegion::kFF, PropellerRegion::kFR, PropellerRegion::kRF, PropellerRegion::kRR}, 7);
  PreparedDataset dataset = testing::DriveDiscrete(YellowfishTwin(), commands, kRows);
  RandomEngine engine(2);
  boost::random::normal_distribution<double> noise(0.0, 0.002);
  for (PreparedRow& row : dataset.rows) {
    row.nu = {row.nu.u + noise(engine), row.nu.v + noise(engine), row.nu.r + noise(engine)};
  }
  for (std::size_t k = 1200; k < kRows; ++k) dataset.rows[k].time_s += 10.0;
  dataset.segments = {{0, 1200}, {1200, kRows}};
  dataset.slices = dataset.segments;
  return dataset;
}

/// All rows still held, the stream's theta is the one-step estimate of the recording.
TEST(LiveBounds, AgreeWithOneStepLeastSquares) {
  const PreparedDataset dataset = NoisyBoat();
  LiveBounds live({}, dataset.sampling_period_s, {kRows, 12});
  for (const PreparedRow& row : dataset.rows) live.Add(row);
  const RegressionProblem problem = BuildRegression(dataset, {});
  for (const Equation equation : kEquations) {
    const EquationProblem& rows = problem.equations[IndexOf(equation)];
    const EquationEstimate batch = EstimateOneStep(*Assess(rows, {}));
    const auto estimate = live.Estimate(equation);
    ASSERT_TRUE(estimate);
    EXPECT_EQ(estimate->rows, static_cast<std::size_t>(rows.y.size()));
    EXPECT_TRUE(estimate->theta.isApprox(batch.theta, 1e-6)) << Name(equation);
    EXPECT_NEAR(estimate->residual_variance, batch.residual_variance,
                1e-6 * batch.residual_variance);
    EXPECT_TRUE((estimate->standard_error.array() > 0.0).all());
  }
}

TEST(LiveBounds, LookAtTheWindowAlone) {
  const PreparedDataset dataset = NoisyBoat();
  LiveBounds live({}, dataset.sampling_period_s, {500, 12});
  for (const PreparedRow& row : dataset.rows) live.Add(row);
  EXPECT_EQ(live.Estimate(Equation::kYaw)->rows, 500u);
}

TEST(LiveBounds, RefuseBeforeThereIsAnythingToGoBy) {
  LiveBounds live({}, 0.2, {});
  EXPECT_FALSE(live.Estimate(Equation::kSurge));
  PreparedRow row;
  live.Add(row);
  EXPECT_THROW(live.Add(row), ContractViolation);
}

}  // namespace
}  // namespace telltale
