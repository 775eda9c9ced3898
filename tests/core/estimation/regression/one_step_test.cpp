#include "telltale/core/estimation/regression/one_step.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "support/discrete_boat.hpp"
#include "telltale/core/paper/yellowfish.hpp"

namespace telltale {
namespace {

using testing::DriveDiscrete;
using testing::RandomCommands;

constexpr auto kFF = PropellerRegion::kFF;
constexpr auto kFR = PropellerRegion::kFR;
constexpr auto kRF = PropellerRegion::kRF;

RegressionProblem ProblemOf(const VesselModel& model, std::uint64_t seed) {
  const auto dataset = DriveDiscrete(model, RandomCommands(4000, {kFF, kFR, kRF}, seed), 50);
  RegressionOptions options;
  options.parameterization = model.parameterization;
  return BuildRegression(dataset, options);
}

EquationEstimate EstimateOf(const EquationProblem& problem) {
  const auto excitation = Assess(problem, {});
  EXPECT_TRUE(excitation.has_value());
  return EstimateOneStep(*excitation);
}

/// Data made by the discrete model gives the published table back: rounding is all that is left.
TEST(OneStep, GivesThePaperTableBack) {
  const VesselModel model = YellowfishPaperModel();
  const auto problem = ProblemOf(model, 7);
  for (const EquationProblem& equation : problem.equations) {
    const EquationEstimate estimate = EstimateOf(equation);
    const Eigen::VectorXd& truth = model.theta[IndexOf(equation.equation)];
    ASSERT_EQ(estimate.theta.size(), truth.size()) << Name(equation.equation);
    for (Eigen::Index j = 0; j < truth.size(); ++j) {
      EXPECT_NEAR(estimate.theta[j], truth[j], 1e-9 * std::abs(truth[j]))
          << Name(equation.equation) << " "
          << equation.regressors[static_cast<std::size_t>(j)].name;
    }
  }
}

TEST(OneStep, RecoversTheSimulatedBoatInThePropellerParameterization) {
  const VesselModel model = YellowfishTwin();
  const auto problem = ProblemOf(model, 11);
  for (const EquationProblem& equation : problem.equations) {
    const EquationEstimate estimate = EstimateOf(equation);
    const Eigen::VectorXd& truth = model.theta[IndexOf(equation.equation)];
    ASSERT_EQ(estimate.theta.size(), truth.size());
    for (Eigen::Index j = 0; j < truth.size(); ++j) {
      EXPECT_NEAR(estimate.theta[j], truth[j], 1e-9 * std::abs(truth[j]));
    }
  }
}

/// An overdetermined problem with noise of its own, to check properties of least squares on.
EquationProblem NoisyYaw() {
  EquationProblem yaw = ProblemOf(YellowfishTwin(), 3).equations[2];
  RandomEngine engine(5);
  boost::random::uniform_real_distribution<double> noise(-0.1, 0.1);
  for (double& value : yaw.y) value += noise(engine);
  return yaw;
}

TEST(OneStep, ResidualIsOrthogonalToEveryRegressor) {
  const EquationProblem yaw = NoisyYaw();
  const EquationEstimate estimate = EstimateOf(yaw);
  const Eigen::VectorXd residual = yaw.y - yaw.phi * estimate.theta;
  for (Eigen::Index j = 0; j < yaw.phi.cols(); ++j) {
    const double cosine = yaw.phi.col(j).dot(residual) / (yaw.phi.col(j).norm() * residual.norm());
    EXPECT_NEAR(cosine, 0.0, 1e-10) << yaw.regressors[static_cast<std::size_t>(j)].name;
  }
}

TEST(OneStep, ResidualVarianceIsThatOfTheResiduals) {
  const EquationProblem yaw = NoisyYaw();
  const EquationEstimate estimate = EstimateOf(yaw);
  const double squares = (yaw.y - yaw.phi * estimate.theta).squaredNorm();
  EXPECT_DOUBLE_EQ(estimate.degrees_of_freedom, static_cast<double>(yaw.y.size() - 13));
  EXPECT_NEAR(estimate.residual_variance, squares / estimate.degrees_of_freedom, 1e-9 * squares);
}

TEST(OneStep, BasisGivesTheInverseOfTheNormalMatrix) {
  const EquationProblem yaw = NoisyYaw();
  const EquationEstimate estimate = EstimateOf(yaw);
  const Eigen::MatrixXd inverse = estimate.basis * estimate.basis.transpose();
  const Eigen::MatrixXd normal = yaw.phi.transpose() * yaw.phi;
  const Eigen::MatrixXd identity = inverse * normal;
  // The condition number of Phi'Phi is below 1e6 here, so 1e-9 leaves room for rounding alone.
  EXPECT_TRUE(identity.isApprox(Eigen::MatrixXd::Identity(13, 13), 1e-9));
}

/// A change of a column's unit changes its coefficient in proportion and nothing else.
TEST(OneStep, RescalingAColumnRescalesItsCoefficientAlone) {
  const EquationProblem yaw = NoisyYaw();
  const EquationEstimate before = EstimateOf(yaw);
  EquationProblem scaled = yaw;
  scaled.phi.col(4) *= 1e6;
  const EquationEstimate after = EstimateOf(scaled);
  for (Eigen::Index j = 0; j < 13; ++j) {
    const double factor = j == 4 ? 1e-6 : 1.0;
    EXPECT_NEAR(after.theta[j], factor * before.theta[j],
                1e-9 * std::abs(factor * before.theta[j]));
  }
}

/// Two identical columns: their sum is determined, each of them is not, the others stay right.
TEST(OneStep, MarksWhatTheDataDoNotDetermine) {
  EquationProblem yaw = NoisyYaw();
  const EquationEstimate before = EstimateOf(yaw);
  yaw.phi.col(1) = yaw.phi.col(3);
  const EquationEstimate estimate = EstimateOf(yaw);
  for (std::size_t j = 0; j < 13; ++j) {
    EXPECT_EQ(estimate.estimable[j], j != 1 && j != 3) << yaw.regressors[j].name;
    EXPECT_TRUE(before.estimable[j]);
  }
  // Minimum norm in scaled coordinates shares the sum evenly.
  EXPECT_NEAR(estimate.theta[1], estimate.theta[3], 1e-9);
}

}  // namespace
}  // namespace telltale
