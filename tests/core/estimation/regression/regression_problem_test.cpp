#include "telltale/core/estimation/regression/regression_problem.hpp"

#include <map>
#include <string_view>

#include <gtest/gtest.h>

#include "telltale/core/base/contract.hpp"

namespace telltale {
namespace {

PreparedRow Row(double u, PropellerCommand delta) {
  PreparedRow row;
  row.nu = {u, 0.1 * u, 0.2 * u};
  row.delta = delta;
  row.region = RegionOf(delta);
  return row;
}

/// Two segments: rows 0..3 in FF, FR, RF, RR, then rows 4..5 in FF.
PreparedDataset TwoSegments() {
  PreparedDataset dataset;
  dataset.sampling_period_s = 0.5;
  dataset.rows = {Row(1.0, {0.5, 0.5}),   Row(2.0, {0.5, -0.5}), Row(4.0, {-0.5, 0.5}),
                  Row(7.0, {-0.5, -0.5}), Row(11.0, {0.5, 0.5}), Row(16.0, {0.5, 0.5})};
  dataset.segments = {{0, 4}, {4, 6}};
  dataset.slices = {{0, 1}, {1, 2}, {2, 3}, {3, 4}, {4, 6}};
  return dataset;
}

TEST(BuildRegression, NeverPairsRowsAcrossAGap) {
  const auto problem = BuildRegression(TwoSegments(), {});
  // Pairs 0-1, 1-2, 2-3 in regions FF, FR, RF and 4-5; the pair 3-4 straddles the gap.
  const EquationProblem& surge = problem.equations[0];
  ASSERT_EQ(surge.y.size(), 4);
  EXPECT_DOUBLE_EQ(surge.y[0], (2.0 - 1.0) / 0.5);
  EXPECT_DOUBLE_EQ(surge.y[1], (4.0 - 2.0) / 0.5);
  EXPECT_DOUBLE_EQ(surge.y[2], (7.0 - 4.0) / 0.5);
  EXPECT_DOUBLE_EQ(surge.y[3], (16.0 - 11.0) / 0.5);
}

TEST(BuildRegression, PaperSurgeTakesForwardRowsAlone) {
  RegressionOptions options;
  options.parameterization = Parameterization::kPaper;
  const auto problem = BuildRegression(TwoSegments(), options);
  EXPECT_EQ(problem.equations[0].y.size(), 2);
  EXPECT_EQ(problem.equations[1].y.size(), 4);
  EXPECT_EQ(problem.equations[2].y.size(), 4);
}

TEST(BuildRegression, TakesReverseRowsOnRequest) {
  PreparedDataset dataset = TwoSegments();
  dataset.segments = {{0, 6}};
  RegressionOptions options;
  EXPECT_EQ(BuildRegression(dataset, options).equations[2].y.size(), 4);
  options.include_reverse = true;
  EXPECT_EQ(BuildRegression(dataset, options).equations[2].y.size(), 5);
}

/// The paper's surge has the forward thrust curve alone: with two propellers in reverse it would be
/// another one.
TEST(BuildRegression, PaperSurgeNeverTakesReverseRows) {
  PreparedDataset dataset = TwoSegments();
  dataset.segments = {{0, 6}};
  RegressionOptions options;
  options.parameterization = Parameterization::kPaper;
  const auto without = BuildRegression(dataset, options);
  options.include_reverse = true;
  const auto with = BuildRegression(dataset, options);
  EXPECT_EQ(with.equations[0].y.size(), without.equations[0].y.size());
  EXPECT_EQ(with.equations[1].y.size(), without.equations[1].y.size() + 1);
}

TEST(BuildRegression, ClustersAreSlicesAndMayBeEmpty) {
  const auto problem = BuildRegression(TwoSegments(), {});
  for (const EquationProblem& equation : problem.equations) {
    ASSERT_EQ(equation.clusters.size(), 5u);
    EXPECT_EQ(equation.clusters[3].size(), 0u);  // RR, and the last row before the gap
    EXPECT_EQ(equation.clusters[4].size(), 1u);
    EXPECT_EQ(equation.clusters[4].end, static_cast<std::size_t>(equation.y.size()));
  }
}

TEST(BuildRegression, RowsHoldTheRegressorsByName) {
  const auto problem = BuildRegression(TwoSegments(), {});
  const EquationProblem& yaw = problem.equations[2];
  const Nu nu{2.0, 0.2, 0.4};  // of row 1, command (0.5, -0.5)
  const std::map<std::string_view, double> expected = {
      {"v|v|", nu.v * nu.v}, {"v|r|", nu.v * nu.r}, {"r|v|", nu.r * nu.v},
      {"r|r|", nu.r * nu.r}, {"uv", nu.u * nu.v},   {"ur", nu.u * nu.r},
      {"v", nu.v},           {"r", nu.r},           {"1", 1.0},
      {"f:d^2", 0.25},       {"f:d", 0.5},          {"r:d^2", -0.25},
      {"r:d", 0.5}};
  ASSERT_EQ(yaw.regressors.size(), expected.size());
  for (std::size_t j = 0; j < yaw.regressors.size(); ++j) {
    EXPECT_DOUBLE_EQ(yaw.phi(1, static_cast<Eigen::Index>(j)), expected.at(yaw.regressors[j].name))
        << yaw.regressors[j].name;
  }
}

TEST(BuildRegression, RejectsASliceOutsideEverySegment) {
  PreparedDataset dataset = TwoSegments();
  dataset.slices.push_back({3, 5});
  EXPECT_THROW(BuildRegression(dataset, {}), ContractViolation);
}

}  // namespace
}  // namespace telltale
