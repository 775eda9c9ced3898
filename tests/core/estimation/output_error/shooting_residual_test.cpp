#include "telltale/core/estimation/output_error/shooting_residual.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "support/stable_boat.hpp"
#include "telltale/core/data/preparation.hpp"
#include "telltale/core/estimation/weak_form/weak_iv.hpp"

namespace telltale {
namespace {

struct Aim {
  PreparedDataset dataset;
  RegressionOptions regression;
  SharedUnknowns unknowns;
  ShootingPlan plan;
};

Aim TakeAim(std::optional<double> time_constant_s, const SensorOptions& sensors,
            double duration_s = 60.0) {
  const VesselModel model = testing::StableBoat(time_constant_s);
  const Vehicle vehicle = testing::StableBoatVehicle();
  const Recording recording =
      Measure(testing::StableBoatTrack(model, duration_s, 5), vehicle, sensors);
  Aim aim;
  aim.dataset = Prepare(recording, vehicle, {}).value();
  aim.regression.structure = model.structure;
  aim.unknowns = {Parameterization::kPropeller,
                  {},
                  time_constant_s.has_value(),
                  AllColumns(Parameterization::kPropeller)};
  aim.plan = CutShootingSegments(aim.dataset, aim.regression, aim.unknowns, {});
  return aim;
}

/// Every fix and every heading of the rows' time is in exactly one shooting segment.
TEST(CutShootingSegments, TakesEveryMeasurementOnce) {
  const Aim aim = TakeAim(std::nullopt, testing::NoisySensors(1.0, 1));
  std::size_t fixes = 0;
  double seconds = 0.0;
  for (const ShootingSegment& shooting_segment : aim.plan.shooting_segments) {
    fixes += shooting_segment.fixes;
    for (const ShootingNode& node : shooting_segment.nodes) seconds += node.leg_s;
  }
  EXPECT_EQ(fixes, aim.dataset.rows.size());
  EXPECT_NEAR(seconds, aim.dataset.EndTime() - aim.dataset.StartTime(), 1e-9);
}

TEST(CutShootingSegments, KeepsToAboutTheLengthAskedFor) {
  const Aim aim = TakeAim(std::nullopt, testing::NoisySensors(1.0, 1));
  for (const ShootingSegment& shooting_segment : aim.plan.shooting_segments) {
    double seconds = 0.0;
    for (const ShootingNode& node : shooting_segment.nodes) seconds += node.leg_s;
    EXPECT_GT(seconds, 4.0);
    EXPECT_LT(seconds, 12.0);
  }
  EXPECT_EQ(aim.plan.shooting_segments.back().cluster + 1, aim.plan.clusters);
}

/// Noise-free sensors and the true model: what is left is the integration's error and, where
/// commands step between headings, the cubic's, both far inside any sensor's noise.
TEST(ComputeShootingResidual, IsZeroFromTheTrueStart) {
  for (const std::optional<double> lag : {std::optional<double>(), std::optional(0.3)}) {
    const VesselModel model = testing::StableBoat(lag);
    const auto track = testing::StableBoatTrack(model, 60.0, 5);
    const Aim aim = TakeAim(lag, testing::NoisySensors(0.0, 1));
    const ShootingSegment& shooting_segment = aim.plan.shooting_segments.front();
    const Eta& eta = track.front().state.eta;
    const Nu& nu = track.front().state.nu;
    ShootingState start;
    start << eta.x_m - aim.dataset.rows.front().eta.x_m, eta.y_m - aim.dataset.rows.front().eta.y_m,
        eta.psi_rad, nu.u, nu.v, nu.r;
    // The frame's origin is the first fix; the track's is the body at time zero.
    const LeverArm arm = testing::StableBoatVehicle().gnss_antenna;
    start[0] -= arm.forward_m;
    start[1] -= arm.starboard_m;
    const auto shooting_residual = ComputeShootingResidual(
        aim.plan, shooting_segment, aim.unknowns, aim.unknowns.In(model), start, {}, false);
    ASSERT_TRUE(shooting_residual.has_value());
    // In noises, of 5 mm and 0.001 rad, the least that sensors are believed to have.
    EXPECT_LT(shooting_residual->residual.cwiseAbs().maxCoeff(), 0.1);
  }
}

class Derivatives : public ::testing::TestWithParam<std::optional<double>> {};

/// All derivatives against central differences of the residuals themselves, some beyond the knees.
TEST_P(Derivatives, AreThoseOfTheResiduals) {
  constexpr double kApart = 1e-6;
  const Aim aim = TakeAim(GetParam(), testing::NoisySensors(1.0, 2));
  const Eigen::VectorXd theta = aim.unknowns.In(testing::StableBoat(GetParam()));
  const NoiseScale noise_scale{1.2, 0.8, 1.5};
  for (const std::size_t i : {0U, 1U, 3U}) {
    const ShootingSegment& shooting_segment = aim.plan.shooting_segments[i];
    const auto at = [&](const Eigen::VectorXd& values, const ShootingState& start) {
      return ComputeShootingResidual(aim.plan, shooting_segment, aim.unknowns, values, start,
                                     noise_scale, false)
          ->residual;
    };
    const ShootingResidual shooting_residual = *ComputeShootingResidual(
        aim.plan, shooting_segment, aim.unknowns, theta, shooting_segment.guess, noise_scale, true);
    EXPECT_EQ(shooting_residual.residual, at(theta, shooting_segment.guess));
    for (Eigen::Index j = 0; j < theta.size(); ++j) {
      const Eigen::VectorXd step = kApart * Eigen::VectorXd::Unit(theta.size(), j);
      const Eigen::VectorXd by =
          (at(theta + step, shooting_segment.guess) - at(theta - step, shooting_segment.guess)) /
          (2.0 * kApart);
      EXPECT_LT((shooting_residual.by_shared.col(j) - by).norm(), 1e-5 * (1.0 + by.norm()))
          << i << " " << j;
    }
    for (Eigen::Index j = 0; j < 6; ++j) {
      const ShootingState step = kApart * ShootingState::Unit(j);
      const Eigen::VectorXd by =
          (at(theta, shooting_segment.guess + step) - at(theta, shooting_segment.guess - step)) /
          (2.0 * kApart);
      EXPECT_LT((shooting_residual.by_start.col(j) - by).norm(), 1e-5 * (1.0 + by.norm()))
          << i << " " << j;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Lags, Derivatives,
                         ::testing::Values(std::optional<double>(), std::optional(0.02),
                                           std::optional(0.4)));

/// Huber's loss as a sum of squares, with threshold k: s^2 up to k, 2 k s - k^2 beyond.
TEST(ComputeShootingResidual, IsHubersBeyondTheThreshold) {
  const Aim aim = TakeAim(std::nullopt, testing::NoisySensors(1.0, 2));
  const Eigen::VectorXd theta = aim.unknowns.In(testing::StableBoat());
  const ShootingSegment& shooting_segment = aim.plan.shooting_segments.front();
  const auto whole = ComputeShootingResidual(aim.plan, shooting_segment, aim.unknowns, theta,
                                             shooting_segment.guess, {}, false)
                         ->residual;
  const auto soft = ComputeShootingResidual(aim.plan, shooting_segment, aim.unknowns, theta,
                                            shooting_segment.guess, {1.0, 1.0, 2.0}, false)
                        ->residual;
  // The first node holds the first fix: north and east lead.
  Eigen::VectorXd shifted = shooting_segment.guess;
  shifted[0] += 10.0;
  const auto far =
      ComputeShootingResidual(aim.plan, shooting_segment, aim.unknowns, theta, shifted, {}, false)
          ->residual;
  const auto near = ComputeShootingResidual(aim.plan, shooting_segment, aim.unknowns, theta,
                                            shifted, {1.0, 1.0, 2.0}, false)
                        ->residual;
  const double s = far.head<2>().norm();
  EXPECT_GT(s, 100.0);
  EXPECT_NEAR(near.head<2>().squaredNorm(), 4.0 * s - 4.0, 1e-9 * s);
  EXPECT_EQ(soft.size(), whole.size());
}

TEST(ComputeShootingResidual, ReportsDivergence) {
  const Aim aim = TakeAim(std::nullopt, testing::NoisySensors(1.0, 2));
  Eigen::VectorXd theta = aim.unknowns.In(testing::StableBoat());
  theta[0] = 20.0;  // speed feeds on its own square
  const ShootingSegment& shooting_segment = aim.plan.shooting_segments.front();
  EXPECT_FALSE(ComputeShootingResidual(aim.plan, shooting_segment, aim.unknowns, theta,
                                       shooting_segment.guess, {}, true)
                   .has_value());
}

}  // namespace
}  // namespace telltale
