#include "telltale/core/paper/partition_study.hpp"

#include <cmath>

#include <gtest/gtest.h>
#include <boost/random/normal_distribution.hpp>

#include "support/discrete_boat.hpp"
#include "telltale/core/paper/yellowfish.hpp"
#include "telltale/core/simulation/simulator.hpp"

namespace telltale {
namespace {

PreparedDataset Simulated(const VesselModel& model, double noise) {
  const auto commands = testing::RandomCommands(
      3000, {PropellerRegion::kFF, PropellerRegion::kFR, PropellerRegion::kRF}, 5);
  PreparedDataset dataset = testing::DriveDiscrete(model, commands, 60);
  RandomEngine engine(2);
  boost::random::normal_distribution<double> normal(0.0, noise);
  for (PreparedRow& row : dataset.rows) {
    row.nu.u += normal(engine);
    row.nu.v += normal(engine);
    row.nu.r += normal(engine);
  }
  return dataset;
}

VesselModel DiscreteModel() {
  VesselModel model = YellowfishTwin();
  model.discretisation = Discretisation::kForwardEuler;
  return model;
}

PartitionOptions Options(PartitionMethod method) {
  PartitionOptions options;
  options.method = method;
  options.repeats = 4;
  return options;
}

TEST(StudyPartitions, ScoresPerfectDataPerfectly) {
  for (const auto method : {PartitionMethod::kBySlices, PartitionMethod::kByPoints}) {
    const auto scores = StudyPartitions(Simulated(DiscreteModel(), 0.0), Options(method));
    ASSERT_TRUE(scores.has_value());
    for (const PartitionScores& s : *scores) {
      EXPECT_NEAR(s.r2.mean, 1.0, 1e-12);
      EXPECT_NEAR(s.mae.mean, 0.0, 1e-10);
      EXPECT_LT(s.constant_velocity_r2.mean, 1.0);
    }
  }
}

/// Free runs need what lies between, so partitions by points have none.
TEST(StudyPartitions, RunsFreelyBySlicesAlone) {
  const auto dataset = Simulated(DiscreteModel(), 1e-5);
  const auto slices = StudyPartitions(dataset, Options(PartitionMethod::kBySlices));
  const auto points = StudyPartitions(dataset, Options(PartitionMethod::kByPoints));
  ASSERT_TRUE(slices.has_value() && points.has_value());
  for (std::size_t j = 0; j < 3; ++j) {
    ASSERT_TRUE((*slices)[j].free_run_rmse.has_value());
    EXPECT_LT((*slices)[j].free_run_rmse->mean,
              0.1 * (*slices)[j].constant_velocity_free_run_rmse->mean);
    EXPECT_FALSE((*points)[j].free_run_rmse.has_value());
  }
}

/// White noise of sigma on nu enters nu(k+1) - nu(k) twice. A fit that leaves both errs by sigma
/// sqrt(2), a mean absolute error of 2 / sqrt(pi) sigma = 1.128 sigma; one that attenuates until it
/// predicts the noise of nu(k) away errs by sigma, sqrt(2 / pi) sigma = 0.798 sigma. Every fit lies
/// between the two.
TEST(StudyPartitions, ReportsTheErrorThatNoiseLeaves) {
  const double noise = 0.01;
  const auto scores =
      StudyPartitions(Simulated(DiscreteModel(), noise), Options(PartitionMethod::kBySlices));
  ASSERT_TRUE(scores.has_value());
  for (const PartitionScores& s : *scores) {
    // 3 % for the scatter of 900 validation rows.
    EXPECT_GT(s.mae.mean, 0.97 * 0.798 * noise);
    EXPECT_LT(s.mae.mean, 1.03 * 1.128 * noise);
    EXPECT_GT(s.mae.standard_deviation, 0.0);
  }
}

TEST(StudyPartitions, TakesTheDynamicStructureToo) {
  VesselModel lagging = DiscreteModel();
  lagging.structure = Structure::kFirstOrderDynamic;
  lagging.thruster_time_constant_s = 0.5;
  PreparedDataset dataset = Simulated(lagging, 0.0);
  VesselState state;
  for (PreparedRow& row : dataset.rows) {
    row.nu = state.nu;
    state = Advance(lagging, state, row.delta, lagging.sampling_period_s);
  }
  PartitionOptions options = Options(PartitionMethod::kBySlices);
  const auto at_once = StudyPartitions(dataset, options);
  options.regression.structure = Structure::kFirstOrderDynamic;
  const auto lagged = StudyPartitions(dataset, options);
  ASSERT_TRUE(at_once.has_value() && lagged.has_value());
  for (std::size_t j = 0; j < 3; ++j) {
    EXPECT_LT((*lagged)[j].free_run_rmse->mean, 0.5 * (*at_once)[j].free_run_rmse->mean) << j;
  }
}

TEST(StudyPartitions, GivesTheSameBitsForAnyThreadCount) {
  const auto dataset = Simulated(DiscreteModel(), 0.01);
  PartitionOptions options = Options(PartitionMethod::kBySlices);
  const auto one = StudyPartitions(dataset, options);
  options.threads = 2;
  const auto two = StudyPartitions(dataset, options);
  for (std::size_t j = 0; j < 3; ++j) {
    EXPECT_EQ((*one)[j].mae.mean, (*two)[j].mae.mean);
    EXPECT_EQ((*one)[j].free_run_rmse->mean, (*two)[j].free_run_rmse->mean);
  }
}

TEST(StudyPartitions, RefusesTooFewSegmentsAndWrongShares) {
  PreparedDataset dataset = Simulated(DiscreteModel(), 0.01);
  dataset.slices = {{0, 1500}, {1500, 3000}};
  EXPECT_FALSE(StudyPartitions(dataset, Options(PartitionMethod::kBySlices)).has_value());
  PartitionOptions options = Options(PartitionMethod::kBySlices);
  options.training_share = 0.8;
  options.validation_share = 0.3;
  ASSERT_TRUE(options.Validate().has_value());
  EXPECT_NE(options.Validate()->reason.find("validation_share"), std::string::npos);
}

}  // namespace
}  // namespace telltale
