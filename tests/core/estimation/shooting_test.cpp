#include "telltale/core/estimation/shooting.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "support/catamaran.hpp"
#include "telltale/core/estimation/weak_iv.hpp"

namespace telltale {
namespace {

struct Aim {
  PreparedDataset dataset;
  RegressionOptions regression;
  SharedUnknowns unknowns;
  ShotPlan plan;
};

Aim TakeAim(std::optional<double> time_constant_s, const SensorOptions& sensors,
            double duration_s = 60.0) {
  const VesselModel model = testing::Catamaran(time_constant_s);
  const Vehicle vehicle = testing::CatamaranVehicle();
  const Recording recording =
      Measure(testing::CatamaranTrack(model, duration_s, 5), vehicle, sensors);
  Aim aim;
  aim.dataset = Prepare(recording, vehicle, {}).value();
  aim.regression.structure = model.structure;
  aim.unknowns = {Parameterization::kPropeller,
                  {},
                  time_constant_s.has_value(),
                  AllColumns(Parameterization::kPropeller)};
  aim.plan = CutShots(aim.dataset, aim.regression, aim.unknowns, {});
  return aim;
}

/// Every fix and every heading of the rows' time is in exactly one shot.
TEST(CutShots, TakesEveryMeasurementOnce) {
  const Aim aim = TakeAim(std::nullopt, testing::CatamaranSensors(1.0, 1));
  std::size_t fixes = 0;
  double seconds = 0.0;
  for (const Shot& shot : aim.plan.shots) {
    fixes += shot.fixes;
    for (const ShotNode& node : shot.nodes) seconds += node.leg_s;
  }
  EXPECT_EQ(fixes, aim.dataset.rows.size());
  EXPECT_NEAR(seconds, aim.dataset.EndTime() - aim.dataset.StartTime(), 1e-9);
}

TEST(CutShots, KeepsToAboutTheLengthAskedFor) {
  const Aim aim = TakeAim(std::nullopt, testing::CatamaranSensors(1.0, 1));
  for (const Shot& shot : aim.plan.shots) {
    double seconds = 0.0;
    for (const ShotNode& node : shot.nodes) seconds += node.leg_s;
    EXPECT_GT(seconds, 4.0);
    EXPECT_LT(seconds, 12.0);
  }
  EXPECT_EQ(aim.plan.shots.back().cluster + 1, aim.plan.clusters);
}

/// Noise-free sensors and the true model: what is left is the integration's error and, where
/// commands step between headings, the cubic's, both far inside any sensor's noise.
TEST(Shoot, MissesNothingFromTheTrueStart) {
  for (const std::optional<double> lag : {std::optional<double>(), std::optional(0.3)}) {
    const VesselModel model = testing::Catamaran(lag);
    const auto track = testing::CatamaranTrack(model, 60.0, 5);
    const Aim aim = TakeAim(lag, testing::CatamaranSensors(0.0, 1));
    const Shot& shot = aim.plan.shots.front();
    const Eta& eta = track.front().state.eta;
    const Nu& nu = track.front().state.nu;
    ShotState start;
    start << eta.x_m - aim.dataset.rows.front().eta.x_m, eta.y_m - aim.dataset.rows.front().eta.y_m,
        eta.psi_rad, nu.u, nu.v, nu.r;
    // The frame's origin is the first fix; the track's is the body at time zero.
    const LeverArm arm = testing::CatamaranVehicle().gnss_antenna;
    start[0] -= arm.forward_m;
    start[1] -= arm.starboard_m;
    const auto miss = Shoot(aim.plan, shot, aim.unknowns, aim.unknowns.In(model), start, {}, false);
    ASSERT_TRUE(miss.has_value());
    // In noises, of 5 mm and 0.001 rad, the least that sensors are believed to have.
    EXPECT_LT(miss->residual.cwiseAbs().maxCoeff(), 0.1);
  }
}

class Derivatives : public ::testing::TestWithParam<std::optional<double>> {};

/// All derivatives against central differences of the residuals themselves, some beyond the knees.
TEST_P(Derivatives, AreThoseOfTheResiduals) {
  constexpr double kApart = 1e-6;
  const Aim aim = TakeAim(GetParam(), testing::CatamaranSensors(1.0, 2));
  const Eigen::VectorXd theta = aim.unknowns.In(testing::Catamaran(GetParam()));
  const Yardstick yardstick{1.2, 0.8, 1.5};
  for (const std::size_t i : {0U, 1U, 3U}) {
    const Shot& shot = aim.plan.shots[i];
    const auto at = [&](const Eigen::VectorXd& values, const ShotState& start) {
      return Shoot(aim.plan, shot, aim.unknowns, values, start, yardstick, false)->residual;
    };
    const Miss miss = *Shoot(aim.plan, shot, aim.unknowns, theta, shot.guess, yardstick, true);
    EXPECT_EQ(miss.residual, at(theta, shot.guess));
    for (Eigen::Index j = 0; j < theta.size(); ++j) {
      const Eigen::VectorXd step = kApart * Eigen::VectorXd::Unit(theta.size(), j);
      const Eigen::VectorXd by =
          (at(theta + step, shot.guess) - at(theta - step, shot.guess)) / (2.0 * kApart);
      EXPECT_LT((miss.by_shared.col(j) - by).norm(), 1e-5 * (1.0 + by.norm())) << i << " " << j;
    }
    for (Eigen::Index j = 0; j < 6; ++j) {
      const ShotState step = kApart * ShotState::Unit(j);
      const Eigen::VectorXd by =
          (at(theta, shot.guess + step) - at(theta, shot.guess - step)) / (2.0 * kApart);
      EXPECT_LT((miss.by_start.col(j) - by).norm(), 1e-5 * (1.0 + by.norm())) << i << " " << j;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Lags, Derivatives,
                         ::testing::Values(std::optional<double>(), std::optional(0.02),
                                           std::optional(0.4)));

/// Huber's loss as a sum of squares: s^2 up to the knee, 2 knee s - knee^2 beyond.
TEST(Shoot, SoftensWhatLiesBeyondTheKnee) {
  const Aim aim = TakeAim(std::nullopt, testing::CatamaranSensors(1.0, 2));
  const Eigen::VectorXd theta = aim.unknowns.In(testing::Catamaran());
  const Shot& shot = aim.plan.shots.front();
  const auto whole = Shoot(aim.plan, shot, aim.unknowns, theta, shot.guess, {}, false)->residual;
  const auto soft =
      Shoot(aim.plan, shot, aim.unknowns, theta, shot.guess, {1.0, 1.0, 2.0}, false)->residual;
  // The first node holds the first fix: north and east lead.
  Eigen::VectorXd shifted = shot.guess;
  shifted[0] += 10.0;
  const auto far = Shoot(aim.plan, shot, aim.unknowns, theta, shifted, {}, false)->residual;
  const auto near =
      Shoot(aim.plan, shot, aim.unknowns, theta, shifted, {1.0, 1.0, 2.0}, false)->residual;
  const double s = far.head<2>().norm();
  EXPECT_GT(s, 100.0);
  EXPECT_NEAR(near.head<2>().squaredNorm(), 4.0 * s - 4.0, 1e-9 * s);
  EXPECT_EQ(soft.size(), whole.size());
}

TEST(Shoot, SaysWhenTheModelRunsAway) {
  const Aim aim = TakeAim(std::nullopt, testing::CatamaranSensors(1.0, 2));
  Eigen::VectorXd theta = aim.unknowns.In(testing::Catamaran());
  theta[0] = 20.0;  // speed feeds on its own square
  const Shot& shot = aim.plan.shots.front();
  EXPECT_FALSE(Shoot(aim.plan, shot, aim.unknowns, theta, shot.guess, {}, true).has_value());
}

}  // namespace
}  // namespace telltale
