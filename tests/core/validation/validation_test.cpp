#include "telltale/core/validation/validation.hpp"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/special_values.hpp"
#include "support/stable_boat_with_effects.hpp"
#include "telltale/core/data/preparation.hpp"
#include "telltale/core/identification/identify.hpp"
#include "telltale/core/paper/sample_mission.hpp"
#include "telltale/core/paper/yellowfish.hpp"
#include "telltale/core/simulation/manoeuvres.hpp"
#include "telltale/core/simulation/sensors.hpp"
#include "telltale/core/simulation/simulator.hpp"

namespace telltale {
namespace {

// Rows taken straight from a simulated track, in one segment.
PreparedDataset Rows(const std::vector<TimedState>& track, double sampling_period_s) {
  PreparedDataset dataset;
  dataset.sampling_period_s = sampling_period_s;
  for (const TimedState& at : track) {
    dataset.rows.push_back({at.time_s, at.state.eta, at.state.nu, at.delta, RegionOf(at.delta)});
  }
  dataset.segments = {{0, dataset.rows.size()}};
  return dataset;
}

PreparedDataset PaperRows(double duration_s) {
  return Rows(Simulate(YellowfishPaperModel(), {}, SampleMission(1), duration_s,
                       kYellowfishSamplingPeriodS),
              kYellowfishSamplingPeriodS);
}

// A discrete boat that keeps its velocity under every command: the constant-velocity baseline.
VesselModel ConstantVelocity(double sampling_period_s) {
  VesselModel model = YellowfishPaperModel();
  model.sampling_period_s = sampling_period_s;
  for (Eigen::VectorXd& theta : model.theta) theta.setZero();
  return model;
}

PreparedDataset SurgeOnly(const std::vector<double>& u, double sampling_period_s) {
  PreparedDataset dataset;
  dataset.sampling_period_s = sampling_period_s;
  for (std::size_t k = 0; k < u.size(); ++k) {
    PreparedRow row;
    row.time_s = static_cast<double>(k) * sampling_period_s;
    row.nu.u = u[k];
    dataset.rows.push_back(row);
  }
  dataset.segments = {{0, u.size()}};
  return dataset;
}

TEST(Validate, TheModelThatMadeTheDataIsPerfect) {
  const auto metrics = Validate(PaperRows(120.0), YellowfishPaperModel(), {});
  ASSERT_TRUE(metrics.has_value());
  for (const OneStepScore& score : metrics->one_step) {
    EXPECT_EQ(score.r2, 1.0);
    EXPECT_EQ(score.mae, 0.0);
    EXPECT_LT(score.constant_velocity_r2, 1.0);
  }
  ASSERT_EQ(metrics->free_run.size(), 3u);
  for (const FreeRunScores& scores : metrics->free_run) {
    EXPECT_NEAR(scores.position_rmse_m, 0.0, 1e-12);
    for (const FreeRunScore& score : scores.velocity) {
      EXPECT_NEAR(score.rmse, 0.0, 1e-12);
      EXPECT_NEAR(score.mae, 0.0, 1e-12);
      EXPECT_NEAR(score.r2, 1.0, 1e-12);
      EXPECT_GT(score.constant_velocity_rmse, 0.0);
    }
  }
}

TEST(Validate, AContinuousModelRunsUnderItsOwnDiscretisation) {
  // Simulated in steps of a tenth of the sampling period; one Runge-Kutta step of 0.2 s differs by
  // its local error, which stays below 1e-4 m/s and rad/s for this boat.
  const auto fine = Simulate(YellowfishTwin(), {}, SampleMission(1), 120.0, 0.02);
  std::vector<TimedState> every_tenth;
  for (std::size_t k = 0; k < fine.size(); k += 10) every_tenth.push_back(fine[k]);
  const auto metrics = Validate(Rows(every_tenth, 0.2), YellowfishTwin(), {});
  ASSERT_TRUE(metrics.has_value());
  for (const FreeRunScores& scores : metrics->free_run) {
    for (const FreeRunScore& score : scores.velocity) EXPECT_LT(score.rmse, 1e-4);
    EXPECT_LT(scores.position_rmse_m, 0.02);
  }
}

TEST(Validate, ConstantVelocityByHandOnThreeRows) {
  // u = 0, 1, 3: the targets 1 and 3 have mean 2 and spread 1 + 1 = 2; no change errs by 1 and 2,
  // so R2 = 1 - (1 + 4) / 2 = -1.5 and MAE = 1.5. In a free run both instants compare with u(0) =
  // 0.
  const PreparedDataset dataset = SurgeOnly({0.0, 1.0, 3.0}, 0.5);
  const auto metrics = Validate(dataset, ConstantVelocity(0.5), {{1.0}});
  ASSERT_TRUE(metrics.has_value());
  const OneStepScore& surge = metrics->one_step[0];
  EXPECT_DOUBLE_EQ(surge.constant_velocity_r2, -1.5);
  EXPECT_DOUBLE_EQ(surge.r2, -1.5);
  EXPECT_DOUBLE_EQ(surge.mae, 1.5);
  ASSERT_EQ(metrics->free_run[0].windows, 1u);
  const FreeRunScore& free = metrics->free_run[0].velocity[0];
  EXPECT_DOUBLE_EQ(free.constant_velocity_rmse, std::sqrt((1.0 + 9.0) / 2.0));
  EXPECT_DOUBLE_EQ(free.rmse, std::sqrt(5.0));
  EXPECT_DOUBLE_EQ(free.mae, 2.0);
  EXPECT_DOUBLE_EQ(free.r2, 1.0 - 10.0 / 2.0);
  // Every measured pose is the origin; held at u(0) = 0 the model stays there too.
  EXPECT_DOUBLE_EQ(metrics->free_run[0].position_rmse_m, 0.0);
}

TEST(Validate, PositionErrorIsTakenAtTheEndOfEachWindow) {
  PreparedDataset dataset = SurgeOnly({2.0, 2.0, 2.0, 2.0, 2.0}, 0.5);
  // Two windows of 1 s: dead reckoning at 2 m/s goes 2 m north in each; the truth went 2 and 5.
  const double north_m[] = {0.0, 7.0, 2.0, -3.0, 7.0};
  for (std::size_t k = 0; k < dataset.rows.size(); ++k) dataset.rows[k].eta.x_m = north_m[k];
  const auto metrics = Validate(dataset, ConstantVelocity(0.5), {{1.0}});
  ASSERT_TRUE(metrics.has_value());
  EXPECT_EQ(metrics->free_run[0].windows, 2u);
  EXPECT_DOUBLE_EQ(metrics->free_run[0].position_rmse_m, std::sqrt((0.0 + 9.0) / 2.0));
}

TEST(Validate, WindowsNeverStraddleAGap) {
  // A jump in velocity from one segment to the next would cost a straddling window dearly.
  PreparedDataset dataset = SurgeOnly({1, 1, 1, 1, 1, 9, 9, 9, 9, 9, 9}, 0.5);
  dataset.segments = {{0, 5}, {5, 11}};
  const auto metrics = Validate(dataset, ConstantVelocity(0.5), {{1.0, 2.0, 2.5}});
  ASSERT_TRUE(metrics.has_value());
  EXPECT_EQ(metrics->free_run[0].windows, 4u);  // rows 0-2, 2-4, 5-7, 7-9
  EXPECT_EQ(metrics->free_run[1].windows, 2u);  // rows 0-4, 5-9
  EXPECT_EQ(metrics->free_run[2].windows, 1u);  // rows 5-10
  EXPECT_DOUBLE_EQ(metrics->one_step[0].mae, 0.0);
  for (const FreeRunScores& scores : metrics->free_run) {
    EXPECT_DOUBLE_EQ(scores.velocity[0].rmse, 0.0);
  }
}

TEST(Validate, AHorizonThatFitsNowhereHasNoWindows) {
  const auto metrics = Validate(PaperRows(4.0), YellowfishPaperModel(), {{1.0, 5.0}});
  ASSERT_TRUE(metrics.has_value());
  EXPECT_EQ(metrics->free_run[0].windows, 4u);
  EXPECT_EQ(metrics->free_run[1].windows, 0u);
  EXPECT_EQ(metrics->free_run[1].horizon_s, 5.0);
}

TEST(Validate, AModelThatDivergesErrsByInfinity) {
  VesselModel explosive = YellowfishPaperModel();
  explosive.theta[0][0] = 1e200;
  explosive.theta[0][3] = -1e200;
  const auto metrics = Validate(PaperRows(60.0), explosive, {{10.0}});
  ASSERT_TRUE(metrics.has_value());
  EXPECT_EQ(metrics->free_run[0].velocity[0].rmse, kInfinity);
  EXPECT_EQ(metrics->free_run[0].velocity[0].r2, -kInfinity);
  EXPECT_EQ(metrics->free_run[0].position_rmse_m, kInfinity);
}

TEST(Validate, AVelocityThatNeverChangesHasNoR2) {
  const auto metrics = Validate(SurgeOnly({1, 1, 1, 1}, 0.5), ConstantVelocity(0.5), {{1.0}});
  ASSERT_TRUE(metrics.has_value());
  EXPECT_TRUE(std::isnan(metrics->one_step[0].r2));
  EXPECT_TRUE(std::isnan(metrics->free_run[0].velocity[0].r2));
}

TEST(Validate, ReportsTheDatasetsNoiseAsTheFloor) {
  PreparedDataset dataset = PaperRows(20.0);
  dataset.nu_noise = {0.01, 0.02, 0.003};
  const auto metrics = Validate(dataset, YellowfishPaperModel(), {{5.0}});
  ASSERT_TRUE(metrics.has_value());
  EXPECT_EQ(metrics->free_run[0].velocity[0].noise_floor, 0.01);
  EXPECT_EQ(metrics->free_run[0].velocity[1].noise_floor, 0.02);
  EXPECT_EQ(metrics->free_run[0].velocity[2].noise_floor, 0.003);
}

TEST(Validate, RefusesDataWithoutAPairOfRows) {
  const auto metrics = Validate(SurgeOnly({1.0}, 0.2), YellowfishPaperModel(), {});
  ASSERT_FALSE(metrics.has_value());
  EXPECT_EQ(metrics.error().subject, "validation");
}

TEST(Validate, RefusesADiscreteModelOfAnotherPeriod) {
  const auto metrics = Validate(SurgeOnly({1.0, 1.0}, 0.1), YellowfishPaperModel(), {});
  ASSERT_FALSE(metrics.has_value());
  EXPECT_EQ(metrics.error().subject, "sampling_period_s");
}

TEST(Validate, RefusesHorizonsOutOfRange) {
  for (const double horizon_s : {0.2, 0.0, -5.0, 601.0, std::nan("")}) {
    const auto metrics = Validate(PaperRows(10.0), YellowfishPaperModel(), {{1.0, horizon_s}});
    ASSERT_FALSE(metrics.has_value()) << horizon_s;
    EXPECT_EQ(metrics.error().subject, "horizons_s");
  }
}

TEST(UsualOptions, LeaveOutHorizonsBelowTwoPeriods) {
  EXPECT_THAT(UsualOptions(0.2).horizons_s, ::testing::ElementsAre(1.0, 5.0, 10.0));
  EXPECT_THAT(UsualOptions(0.5).horizons_s, ::testing::ElementsAre(1.0, 5.0, 10.0));
  EXPECT_THAT(UsualOptions(1.0).horizons_s, ::testing::ElementsAre(5.0, 10.0));
  EXPECT_THAT(UsualOptions(3.0).horizons_s, ::testing::ElementsAre(10.0));
}

TEST(Validate, NamesTheHorizonAndItsRange) {
  const auto metrics = Validate(PaperRows(10.0), YellowfishPaperModel(), {{601.5}});
  ASSERT_FALSE(metrics.has_value());
  EXPECT_EQ(metrics.error().reason, "601.5 s is out of range");
  EXPECT_EQ(metrics.error().advice, "choose horizons from two sampling periods (0.4 s) to 600 s");
}

// Positions are those that the sensors show, an antenna half a metre off among them.
TEST(Validate, PredictsPositionsAsTheModelsSensorsShowThem) {
  const std::vector<ModelledEffect> effects = {{FindEffect("antenna_lever_arm"), {0.5, 0.0}}};
  const PreparedDataset dataset = testing::SimulateWithEffects(effects, 120.0, 1);
  const auto scores = Validate(dataset, AugmentedModel{testing::StableBoat(), effects}, {{1.0}});
  const auto without = Validate(dataset, testing::StableBoat(), {{1.0}});
  ASSERT_TRUE(scores && without);
  EXPECT_LT(scores->free_run.front().position_rmse_m, 0.05);
  EXPECT_LT(scores->free_run.front().position_rmse_m, without->free_run.front().position_rmse_m);
}

TEST(ScoreFreeRuns, SaysWhatValidateSaysOfOneHorizon) {
  const auto track = Simulate(YellowfishTwin(), {}, SampleMission(1), 180.0, 0.02);
  const Recording recording = Measure(track, YellowfishVehicle(), {});
  const auto dataset = Prepare(recording, YellowfishVehicle(), PrepareOptions::Robust());
  ASSERT_TRUE(dataset);
  for (const Structure structure : {Structure::kFossen, Structure::kStaticQuadratic}) {
    IdentifyOptions options;
    options.regression.structure = structure;
    options.prepare.sampling_period_s = dataset->sampling_period_s;
    const auto model = Identify(recording, YellowfishVehicle(), options);
    ASSERT_TRUE(model);
    const auto metrics = Validate(*dataset, *model, {{5.0}});
    const auto scores = ScoreFreeRuns(*dataset, *model, 5.0);
    ASSERT_TRUE(metrics && scores);
    EXPECT_GT(scores->windows, 30u);
    EXPECT_EQ(scores->windows, metrics->free_run.front().windows);
    EXPECT_EQ(scores->position_rmse_m, metrics->free_run.front().position_rmse_m);
    EXPECT_FALSE(ScoreFreeRuns(*dataset, *model, 700.0));
  }
}

}  // namespace
}  // namespace telltale
