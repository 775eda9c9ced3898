#include "estimation/lagged_regression.hpp"

#include <cmath>

#include <boost/random/normal_distribution.hpp>
#include <gtest/gtest.h>

#include "simulation/simulator.hpp"
#include "simulation/yellowfish.hpp"
#include "support/discrete_boat.hpp"

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

std::array<std::optional<Excitation>, 3> AssessAll(const LaggedProblem& problem) {
  std::array<std::optional<Excitation>, 3> excitations;
  for (std::size_t j = 0; j < 3; ++j) {
    excitations[j] = *Assess(problem.WithoutLag(kEquations[j]), {});
  }
  return excitations;
}

class KnownLag : public ::testing::TestWithParam<double> {};

/// One alpha and every physical coefficient come back from data made by the discrete model.
TEST_P(KnownLag, IsRecoveredWithEveryCoefficient) {
  const VesselModel truth = LaggingTwin(GetParam());
  const auto problem = BuildLagged(Drive(truth, 4000), {});
  const LaggedEstimate estimate = EstimateLagged(problem, AssessAll(problem));
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

/// The Jacobian that bounds rest on is that of the residual, checked by central differences in alpha:
/// for fixed theta the residual is exactly linear in alpha.
TEST(EstimateLagged, JacobianIsTheDerivativeOfTheResidual) {
  PreparedDataset dataset = Drive(LaggingTwin(0.4), 1000);
  RandomEngine engine(8);
  boost::random::normal_distribution<double> noise(0.0, 1e-3);
  for (PreparedRow& row : dataset.rows) row.nu.u += noise(engine);
  const auto problem = BuildLagged(dataset, {});
  const LaggedEstimate estimate = EstimateLagged(problem, AssessAll(problem));
  // At a least-squares solution the residual is orthogonal to every column of the Jacobian.
  const Eigen::VectorXd gradient = estimate.jacobian.transpose() * estimate.residual;
  for (Eigen::Index j = 0; j < gradient.size(); ++j) {
    const double scale = estimate.jacobian.col(j).norm() * estimate.residual.norm();
    EXPECT_NEAR(gradient[j] / scale, 0.0, 1e-4) << j;
  }
}

TEST(BuildLagged, NeverUsesRowsAcrossAGap) {
  PreparedDataset dataset = Drive(LaggingTwin(0.4), 100);
  dataset.stretches = {{0, 40}, {40, 100}};
  dataset.segments = {{0, 40}, {40, 100}};
  const auto problem = BuildLagged(dataset, {});
  EXPECT_EQ(problem.equations[2].clusters[0].size(), 38u);
  EXPECT_EQ(problem.equations[2].clusters[1].size(), 58u);
}

TEST(BuildLagged, WithoutLagIsTheStaticProblemOneCommandLate) {
  const PreparedDataset dataset = Drive(LaggingTwin(0.4), 100);
  const auto problem = BuildLagged(dataset, {});
  const EquationProblem yaw = problem.WithoutLag(Equation::kYaw);
  EXPECT_DOUBLE_EQ(yaw.y[0], (dataset.rows[2].nu.r - dataset.rows[1].nu.r) / 0.2);
  EXPECT_DOUBLE_EQ(yaw.phi(0, 7), dataset.rows[1].nu.r);
  const auto thrust = ThrustOf(Parameterization::kPropeller, dataset.rows[0].delta);
  EXPECT_DOUBLE_EQ(yaw.phi(0, 10), thrust.turning[1]);
}

}  // namespace
}  // namespace telltale
