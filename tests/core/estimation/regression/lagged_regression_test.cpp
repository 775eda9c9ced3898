#include "telltale/core/estimation/regression/lagged_regression.hpp"

#include <cmath>

#include <gtest/gtest.h>
#include <boost/random/normal_distribution.hpp>

#include "support/discrete_boat.hpp"
#include "telltale/core/paper/yellowfish.hpp"
#include "telltale/core/simulation/simulator.hpp"

namespace telltale {
namespace {

VesselModel LaggingTwin(double time_constant_s) {
  VesselModel model = YellowfishTwin();
  model.structure = Structure::kFirstOrderDynamic;
  model.discretisation = Discretisation::kForwardEuler;
  model.thruster_time_constant_s = time_constant_s;
  return model;
}

/// Rows made by the discrete model with lagging thrusters.
PreparedDataset Drive(const VesselModel& model, std::size_t steps) {
  const auto commands = testing::RandomCommands(
      steps, {PropellerRegion::kFF, PropellerRegion::kFR, PropellerRegion::kRF}, 5);
  PreparedDataset dataset = testing::DriveDiscrete(model, commands, 50);
  VesselState state;
  for (PreparedRow& row : dataset.rows) {
    row.nu = state.nu;
    state = Advance(model, state, row.delta, model.sampling_period_s);
  }
  return dataset;
}

std::array<std::optional<Excitation>, 3> AssessExcitation(const LaggedProblem& problem) {
  std::array<std::optional<Excitation>, 3> excitations;
  for (std::size_t j = 0; j < 3; ++j) {
    excitations[j] = *Assess(problem.at_once.equations[j], {});
  }
  return excitations;
}

class KnownLag : public ::testing::TestWithParam<double> {};

/// One alpha and every physical coefficient come back from data made by the discrete model.
TEST_P(KnownLag, IsRecoveredWithEveryCoefficient) {
  const VesselModel truth = LaggingTwin(GetParam());
  const auto problem = BuildLagged(Drive(truth, 4000), {});
  const LaggedEstimate estimate = EstimateLagged(problem, AssessExcitation(problem));
  EXPECT_NEAR(estimate.time_constant_s, GetParam(), 1e-8 * GetParam());
  for (std::size_t j = 0; j < 3; ++j) {
    ASSERT_TRUE(estimate.equations[j].has_value());
    const Eigen::VectorXd& theta = estimate.equations[j]->theta;
    ASSERT_EQ(theta.size(), truth.theta[j].size());
    for (Eigen::Index i = 0; i < theta.size(); ++i) {
      EXPECT_NEAR(theta[i], truth.theta[j][i], 1e-8 * std::abs(truth.theta[j][i])) << j << " " << i;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Seconds, KnownLag, ::testing::Values(0.1, 0.3, 1.0, 5.0));

/// The Jacobian that bounds rest on is that of the residual, checked by central differences in
/// alpha: for fixed theta the residual is exactly linear in alpha.
TEST(EstimateLagged, JacobianIsTheDerivativeOfTheResidual) {
  PreparedDataset dataset = Drive(LaggingTwin(0.4), 1000);
  RandomEngine engine(8);
  boost::random::normal_distribution<double> noise(0.0, 1e-3);
  for (PreparedRow& row : dataset.rows) row.nu.u += noise(engine);
  const auto problem = BuildLagged(dataset, {});
  const LaggedEstimate estimate = EstimateLagged(problem, AssessExcitation(problem));
  // At a least-squares solution the residual is orthogonal to every column of the Jacobian.
  const Eigen::VectorXd gradient = estimate.jacobian.transpose() * estimate.residual;
  for (Eigen::Index j = 0; j < gradient.size(); ++j) {
    const double scale = estimate.jacobian.col(j).norm() * estimate.residual.norm();
    EXPECT_NEAR(gradient[j] / scale, 0.0, 1e-4) << j;
  }
}

/// A boat without lag is inside the model class: the lag goes to its lower bound and the rest is
/// right.
TEST(EstimateLagged, FindsNoLagWhereThereIsNone) {
  VesselModel truth = YellowfishTwin();
  const auto dataset = testing::DriveDiscrete(
      truth,
      testing::RandomCommands(
          4000, {PropellerRegion::kFF, PropellerRegion::kFR, PropellerRegion::kRF}, 5),
      50);
  const auto problem = BuildLagged(dataset, {});
  const LaggedEstimate estimate = EstimateLagged(problem, AssessExcitation(problem));
  EXPECT_TRUE(estimate.lag_at_lower_bound);
  EXPECT_LT(estimate.time_constant_s, 0.001);
  for (std::size_t j = 0; j < 3; ++j) {
    EXPECT_TRUE(estimate.equations[j]->theta.isApprox(truth.theta[j], 1e-2));
  }
}

/// Each segment begins in a thrust of its own that nothing tells: what it does is projected out, so
/// a recording cut in two gives the same lag.
TEST(EstimateLagged, DoesNotNeedTheThrustAtTheStartOfASegment) {
  const VesselModel truth = LaggingTwin(1.0);
  PreparedDataset dataset = Drive(truth, 4000);
  dataset.segments = {{0, 1010}, {1010, 2033}, {2033, 4000}};
  dataset.slices = dataset.segments;
  const auto problem = BuildLagged(dataset, {});
  EXPECT_NEAR(EstimateLagged(problem, AssessExcitation(problem)).time_constant_s, 1.0, 1e-5);
}

/// The boat pushed about by white noise, so that (22) holds with white residuals.
PreparedDataset DriveDisturbed(const VesselModel& model, std::size_t steps, std::uint64_t seed) {
  RandomEngine engine(seed);
  boost::random::normal_distribution<double> push(0.0, 0.02);
  const auto commands = testing::RandomCommands(
      steps, {PropellerRegion::kFF, PropellerRegion::kFR, PropellerRegion::kRF}, seed);
  PreparedDataset dataset = testing::DriveDiscrete(model, commands, 50);
  VesselState state;
  const double h = model.sampling_period_s;
  for (PreparedRow& row : dataset.rows) {
    row.nu = state.nu;
    state = Advance(model, state, row.delta, h);
    state.nu = {state.nu.u + h * push(engine), state.nu.v + h * push(engine),
                state.nu.r + h * push(engine)};
  }
  return dataset;
}

/// Wilks: at the truth the deviance is chi-square with one degree of freedom. Of 60, its mean is
/// known to 0.18, and 3 are expected above 3.84, hardly ever more than 9.
TEST(LagDeviance, IsChiSquareAtTheTruth) {
  constexpr double kTruth = 0.15;
  const VesselModel boat = LaggingTwin(kTruth);
  double mean = 0.0;
  int above = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    const auto problem = BuildLagged(DriveDisturbed(boat, 600, seed), {});
    const auto excitations = AssessExcitation(problem);
    const LaggedEstimate estimate = EstimateLagged(problem, excitations);
    EXPECT_NEAR(LagDeviance(problem, excitations, estimate, estimate.time_constant_s), 0.0, 1e-6);
    const double deviance = LagDeviance(problem, excitations, estimate, kTruth);
    EXPECT_GE(deviance, -0.01);  // the weights of the estimate have settled to some digits only
    mean += deviance / 60.0;
    above += deviance > 3.8415 ? 1 : 0;
  }
  EXPECT_NEAR(mean, 1.0, 0.6);
  EXPECT_LE(above, 9);
}

}  // namespace
}  // namespace telltale
