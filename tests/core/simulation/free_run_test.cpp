#include "telltale/core/simulation/free_run.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "support/discrete_boat.hpp"
#include "telltale/core/paper/yellowfish.hpp"

namespace telltale {
namespace {

constexpr double kHorizonS = 5.0;

/// As DriveDiscrete steps it.
VesselModel Discrete() {
  VesselModel boat = YellowfishTwin();
  boat.discretisation = Discretisation::kForwardEuler;
  return boat;
}

PreparedDataset SimulatedDataset() {
  return testing::DriveDiscrete(YellowfishTwin(),
                                testing::RandomCommands(1000, {PropellerRegion::kFF}, 3), 50);
}

/// The boat that made the data is at every row where the data say it is.
TEST(RunFreely, FollowsTheDataOfTheBoatItself) {
  const PreparedDataset dataset = SimulatedDataset();
  const VesselModel boat = Discrete();
  const auto run = RunFreely(dataset, boat, FollowThrust(dataset, boat), 100, 50);
  ASSERT_EQ(run.size(), 51u);
  for (std::size_t k = 0; k < run.size(); ++k) {
    EXPECT_NEAR(run[k].nu.u, dataset.rows[100 + k].nu.u, 1e-12);
    EXPECT_NEAR(run[k].nu.r, dataset.rows[100 + k].nu.r, 1e-12);
  }
}

/// By the definition of the lag: a constant command leaves (1 - T) e^(-t / T_c) of a step to come.
TEST(FollowThrust, LagsByTheTimeConstant) {
  PreparedDataset dataset = SimulatedDataset();
  VesselModel boat = YellowfishTwin();
  boat.structure = Structure::kFirstOrderDynamic;
  boat.thruster_time_constant_s = 0.5;
  dataset.rows[0].delta = {0.2, 0.2};
  for (std::size_t k = 1; k < dataset.rows.size(); ++k) dataset.rows[k].delta = {0.6, 0.6};
  const ThrustHistory thrust = FollowThrust(dataset, boat);
  const double before = boat.SteadyThrust({0.2, 0.2}).surge[0];
  const double after = boat.SteadyThrust({0.6, 0.6}).surge[0];
  const double elapsed_s = 9.0 * dataset.sampling_period_s;
  EXPECT_NEAR(thrust[10].surge[0], after + (before - after) * std::exp(-elapsed_s / 0.5), 1e-9);
}

TEST(CountDivergences, FindsNoneWhereTheBoatMadeTheData) {
  const PreparedDataset dataset = SimulatedDataset();
  const DivergenceCount count = CountDivergences(dataset, Discrete(), kHorizonS);
  EXPECT_GT(count.runs, 10u);
  EXPECT_EQ(count.diverged, 0u);
}

/// With u' = + 2 u a speed grows by e^10 in five seconds.
TEST(CountDivergences, FindsAllOfAnUnstableModel) {
  const PreparedDataset dataset = SimulatedDataset();
  VesselModel boat = Discrete();
  const auto regressors = Regressors(Equation::kSurge, boat.parameterization);
  for (std::size_t i = 0; i < regressors.size(); ++i) {
    if (regressors[i].name == "u") boat.theta[0][static_cast<Eigen::Index>(i)] = 2.0;
  }
  const DivergenceCount count = CountDivergences(dataset, boat, kHorizonS);
  EXPECT_GT(count.runs, 10u);
  EXPECT_GE(count.diverged + 1, count.runs);  // the first starts at rest
}

/// Of hours of data some sixty runs are looked at, not thousands.
TEST(CountDivergences, CountsSomeSixtyOfManyRuns) {
  const PreparedDataset dataset = testing::DriveDiscrete(
      YellowfishTwin(), testing::RandomCommands(20000, {PropellerRegion::kFF}, 3), 50);
  const std::size_t runs = CountDivergences(dataset, Discrete(), kHorizonS).runs;
  EXPECT_GT(runs, 30u);
  EXPECT_LE(runs, 60u);
}

TEST(FreeRunError, IsZeroForTheModelThatMadeTheData) {
  EXPECT_LT(FreeRunError(SimulatedDataset(), Discrete(), kHorizonS), 1e-9);
}

/// Unless it starts at rest, such a boat is soon further off than counts.
TEST(FreeRunError, OfADivergingModelIsFinite) {
  VesselModel boat = Discrete();
  boat.theta[0].setConstant(1e9);
  boat.theta[1].setConstant(1e9);
  boat.theta[2].setConstant(1e9);
  const double miss = FreeRunError(SimulatedDataset(), boat, kHorizonS);
  EXPECT_GT(miss, 1.5);
  EXPECT_LE(miss, 2.0);
}

/// The error of a boat at rest is the measured velocity: less than the fastest, since the mean
/// is.
TEST(FreeRunError, IsInUnitsOfTheFastestMeasured) {
  const PreparedDataset dataset = SimulatedDataset();
  VesselModel boat = Discrete();
  for (Eigen::VectorXd& theta : boat.theta) theta.setZero();  // keeps its velocities
  double squares = 0.0;
  const Nu fastest = FastestOf(dataset);
  const auto steps = static_cast<std::size_t>(std::lround(kHorizonS / dataset.sampling_period_s));
  const auto starts = FreeRunStarts(dataset, steps);
  ASSERT_LE(starts.size(), 60u);  // so that all are looked at
  for (const std::size_t first : starts) {
    const Nu& kept = dataset.rows[first].nu;
    for (std::size_t k = first + 1; k <= first + steps; ++k) {
      const Nu& nu = dataset.rows[k].nu;
      squares += std::pow((nu.u - kept.u) / fastest.u, 2) +
                 std::pow((nu.v - kept.v) / fastest.v, 2) +
                 std::pow((nu.r - kept.r) / fastest.r, 2);
    }
  }
  const auto misses = static_cast<double>(3 * steps * starts.size());
  EXPECT_NEAR(FreeRunError(dataset, boat, kHorizonS), std::sqrt(squares / misses), 1e-12);
}

}  // namespace
}  // namespace telltale
