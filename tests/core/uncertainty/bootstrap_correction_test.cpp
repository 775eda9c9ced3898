#include "telltale/core/uncertainty/bootstrap_correction.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "coverage/independent_simulator.hpp"
#include "telltale/core/base/linear_algebra/eigen_decompositions.hpp"
#include "telltale/core/base/parallel.hpp"
#include "telltale/core/data/preparation.hpp"
#include "telltale/core/estimation/regression/one_step.hpp"
#include "telltale/core/uncertainty/clustered_fit.hpp"
#include "telltale/core/uncertainty/distributions.hpp"

namespace telltale {
namespace {

PreparedDataset Simulated(std::uint64_t seed,
                          const coverage::SimulatedEnvironment& environment = {}) {
  coverage::Mission mission;
  mission.segments = 15;
  const Recording recording =
      coverage::Simulate(coverage::ReferenceBoat(), environment, mission, seed);
  PrepareOptions options;
  options.smoothing_half_width = 4;
  return *Prepare(recording, coverage::VehicleOf(), options);
}

Eigen::VectorXd Truth() {
  const std::vector<double> truth = coverage::CoefficientsOf(coverage::ReferenceBoat());
  return Eigen::Map<const Eigen::VectorXd>(truth.data(), static_cast<Eigen::Index>(truth.size()));
}

TEST(BootstrapCorrection, DoesNotDependOnThreads) {
  const PreparedDataset dataset = Simulated(1);
  const auto fit = EstimateWeakIv(dataset, {}, AllColumns(Parameterization::kPropeller), {});
  ASSERT_TRUE(fit.has_value());
  const auto one = CorrectByParametricBootstrap(
      dataset, {}, *fit, AllColumns(Parameterization::kPropeller), {}, {8, 3, 1});
  const auto two = CorrectByParametricBootstrap(
      dataset, {}, *fit, AllColumns(Parameterization::kPropeller), {}, {8, 3, 2});
  ASSERT_TRUE(one && two);
  EXPECT_EQ(one->theta, two->theta);
  EXPECT_EQ(one->covariance, two->covariance);
}

TEST(BootstrapCorrection, ReportsProgress) {
  const PreparedDataset dataset = Simulated(1);
  const auto fit = EstimateWeakIv(dataset, {}, AllColumns(Parameterization::kPropeller), {});
  ASSERT_TRUE(fit.has_value());
  std::vector<double> told;
  CorrectByParametricBootstrap(dataset, {}, *fit, AllColumns(Parameterization::kPropeller), {},
                               {8, 3, 2}, [&](double fraction) { told.push_back(fraction); });
  ASSERT_EQ(told.size(), 8U);
  EXPECT_EQ(told.back(), 1.0);
}

Disturbance DisturbanceSeen(const PreparedDataset& dataset) {
  const auto columns = AllColumns(Parameterization::kPropeller);
  const auto fit = EstimateWeakIv(dataset, {}, columns, {});
  const auto disturbance = fit ? DisturbanceFromResiduals(dataset, {}, *fit, {}, 3) : std::nullopt;
  return disturbance.value_or(Disturbance{});
}

TEST(BootstrapCorrection, SeparatesGnssDriftFromDisturbance) {
  coverage::SimulatedEnvironment environment;
  environment.position_drift_m = 0.2;
  environment.position_drift_time_s = 20.0;
  const double within_a_second_m = 0.2 * std::sqrt(2.0 * (1.0 - std::exp(-1.0 / 20.0)));
  for (const std::uint64_t seed : {1, 2, 3}) {
    const Disturbance drifting = DisturbanceSeen(Simulated(seed, environment));
    const Disturbance still = DisturbanceSeen(Simulated(seed));
    // Ten minutes are 600 steps of drift, north and east: the size is known to 3 %, and what is
    // taken for the boat's own way, in windows of two seconds, a few per cent more.
    EXPECT_NEAR(drifting.gnss_drift_m, within_a_second_m, 0.15 * within_a_second_m);
    EXPECT_EQ(still.gnss_drift_m, 0.0);
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      // Taken for a disturbance it made one five times as strong that lasts 0.2 s.
      EXPECT_LT(drifting.sigma[axis], 2.0 * still.sigma[axis]) << axis;
      EXPECT_GT(drifting.sigma[axis], 0.5 * still.sigma[axis]) << axis;
      EXPECT_GT(drifting.time_constant_s[axis], 2.0) << axis;
    }
  }
}

// The short version of bench/coverage: the whole campaign stands in docs/validation/coverage.md.
// The data come from a simulator of its own, integrated twenty times finer.
TEST(BootstrapCorrection, BoundsHoldTheTruthAsOftenAsTheySay) {
  constexpr std::size_t kRepeats = 60;
  std::vector<std::vector<bool>> held(kRepeats);
  std::vector<std::size_t> one_step_held(kRepeats, 0);
  std::vector<std::size_t> ellipsoid_held(kRepeats, 0);
  const Eigen::VectorXd truth = Truth();
  ForEachIndex(kRepeats, 2, [&](std::size_t i) {
    const PreparedDataset dataset = Simulated(500 + i);
    const auto fit = EstimateWeakIv(dataset, {}, AllColumns(Parameterization::kPropeller), {});
    if (!fit) return;
    const auto corrected = CorrectByParametricBootstrap(
        dataset, {}, *fit, AllColumns(Parameterization::kPropeller), {}, {40, i, 1});
    if (!corrected) return;
    const double t = StudentQuantile(corrected->degrees_of_freedom, 0.975);
    for (Eigen::Index j = 0; j < truth.size(); ++j) {
      held[i].push_back(std::abs(corrected->theta[j] - truth[j]) <=
                        t * corrected->interval_factors[j] *
                            std::sqrt(corrected->covariance(j, j)));
    }
    const Eigen::VectorXd off = corrected->theta - truth;
    const double distance = off.dot(corrected->covariance.ldlt().solve(off));
    ellipsoid_held[i] = distance <= SquaredRadius(corrected->joint, 35, 0.95) ? 1 : 0;
    const EquationProblem surge = BuildRegression(dataset, {}).equations[0];
    const EquationEstimate one_step = EstimateOneStep(*Assess(surge, {}));
    const Eigen::MatrixXd covariance = ResidualCovariance(FitOf(surge, one_step));
    for (Eigen::Index j = 0; j < one_step.theta.size(); ++j) {
      const double missed = std::abs(one_step.theta[j] - truth[j]);
      one_step_held[i] += missed <= 1.96 * std::sqrt(covariance(j, j)) ? 1 : 0;
    }
  });
  double all = 0.0;
  for (Eigen::Index j = 0; j < truth.size(); ++j) {
    double of_this = 0.0;
    for (const auto& repeat : held) {
      ASSERT_EQ(repeat.size(), 35U) << "an estimate failed";
      of_this += repeat[static_cast<std::size_t>(j)] ? 100.0 / kRepeats : 0.0;
    }
    // One coefficient in 60 repeats: 95 % give or take 2.8 points, and there are 35 of them.
    EXPECT_GE(of_this, 83.0) << "coefficient " << j;
    all += of_this / static_cast<double>(truth.size());
  }
  // Coefficients of one repeat err together; over 60 repeats their mean is known to about a point.
  EXPECT_GE(all, 92.0);
  EXPECT_LE(all, 98.0);
  // All coefficients at once: 95 % give or take 2.8 points, thrice.
  const auto ellipsoids = std::count(ellipsoid_held.begin(), ellipsoid_held.end(), 1U);
  EXPECT_GE(100.0 * static_cast<double>(ellipsoids) / kRepeats, 86.0);
  double paper = 0.0;
  for (const std::size_t count : one_step_held) {
    paper += 100.0 * static_cast<double>(count) / (9.0 * kRepeats);
  }
  EXPECT_LT(paper, 60.0);  // the recipe that this is meant to replace
}

}  // namespace
}  // namespace telltale
