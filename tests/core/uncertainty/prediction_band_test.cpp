#include "telltale/core/uncertainty/prediction_band.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "support/stable_boat.hpp"

namespace telltale {
namespace {

/// Nothing but a constant acceleration ahead.
VesselModel Accelerating(double mps2) {
  VesselModel model = testing::StableBoat();
  for (Eigen::VectorXd& theta : model.theta) theta.setZero();
  model.theta[0][4] = mps2;
  return model;
}

TEST(PredictionBand, HoldsTheQuantilesOfItsModels) {
  std::vector<VesselModel> models;
  for (int i = 0; i <= 100; ++i) models.push_back(Accelerating(0.01 * i));
  const PredictionBand band = PredictBand(models, {}, {{0.0, {}}}, Disturbance{}, 2.0, 0.1, 0.9, 1);
  ASSERT_EQ(band.lower.cols(), 20);
  EXPECT_NEAR(band.lower(0, 19), 0.05 * 2.0, 1e-12);
  EXPECT_NEAR(band.median(0, 19), 0.50 * 2.0, 1e-12);
  EXPECT_NEAR(band.upper(0, 19), 0.95 * 2.0, 1e-12);
  EXPECT_EQ(band.upper(1, 19), 0.0);
}

// Velocity driven by Gauss-Markov acceleration from rest: Var u(t) = 2 sigma^2 tau^2 (t/tau - 1 +
// exp(-t/tau)). Source: Gelb, Applied Optimal Estimation, 1974, the integrated exponentially
// correlated process.
TEST(PredictionBand, WidensAsADisturbanceIntegrates) {
  Disturbance pushed;
  pushed.sigma << 0.1, 0.0, 0.0;
  pushed.time_constant_s << 2.0, 1.0, 1.0;
  const std::vector<VesselModel> models(4000, Accelerating(0.0));
  const PredictionBand band = PredictBand(models, {}, {{0.0, {}}}, pushed, 6.0, 0.02, 0.95, 3);
  const double spread = 0.1 * 2.0 * std::sqrt(2.0 * (3.0 - 1.0 + std::exp(-3.0)));
  // A 95 % quantile of 4000 runs is known to about 3 %.
  EXPECT_NEAR(band.upper(0, 299), 1.96 * spread, 0.1 * spread * 1.96);
  EXPECT_NEAR(band.lower(0, 299), -1.96 * spread, 0.1 * spread * 1.96);
}

TEST(PredictionBand, DoesNotHideModelsThatDiverge) {
  std::vector<VesselModel> models(20, Accelerating(0.1));
  models[4].theta[0][0] = 500.0;
  models[4].theta[0][4] = 1e3;
  const PredictionBand band =
      PredictBand(models, {}, {{0.0, {}}}, Disturbance{}, 5.0, 0.1, 0.99, 1);
  EXPECT_TRUE(std::isinf(band.upper(0, 49)));
  EXPECT_NEAR(band.median(0, 49), 0.5, 1e-9);
}

}  // namespace
}  // namespace telltale
