#include "telltale/core/estimation/regression/excitation_summary.hpp"

#include <cmath>
#include <numeric>

#include <gtest/gtest.h>

#include "support/discrete_boat.hpp"
#include "telltale/core/base/linear_algebra/eigen_decompositions.hpp"
#include "telltale/core/paper/yellowfish.hpp"

namespace telltale {
namespace {

EquationProblem SurgeIn(const std::vector<PropellerRegion>& regions) {
  return BuildRegression(testing::DriveDiscrete(YellowfishTwin(),
                                                testing::RandomCommands(3000, regions, 7), 50),
                         {})
      .equations[0];
}

/// By definition: ||x_j||^2 [(Phi'Phi)^-1]_jj, the normal equations solved outright.
TEST(ExcitationSummary, VarianceInflationIsThatOfTheNormalEquations) {
  const EquationProblem surge =
      SurgeIn({PropellerRegion::kFF, PropellerRegion::kFR, PropellerRegion::kRF});
  const ExcitationSummary summary = Summarise(*Assess(surge, {}), surge.regressors.size());
  const Eigen::MatrixXd gram = surge.phi.transpose() * surge.phi;
  const Eigen::MatrixXd inverse =
      gram.ldlt().solve(Eigen::MatrixXd(Eigen::MatrixXd::Identity(gram.rows(), gram.cols())));
  for (Eigen::Index j = 0; j < gram.cols(); ++j) {
    const double expected = gram(j, j) * inverse(j, j);
    const double inflation = summary.variance_inflation[static_cast<std::size_t>(j)];
    EXPECT_NEAR(inflation, expected, 1e-6 * expected);
    EXPECT_GE(inflation, 1.0 - 1e-12);
  }
}

/// Another unit for a column rescales its coefficient and changes no verdict.
TEST(ExcitationSummary, DoesNotDependOnUnits) {
  EquationProblem surge =
      SurgeIn({PropellerRegion::kFF, PropellerRegion::kFR, PropellerRegion::kRF});
  const ExcitationSummary before = Summarise(*Assess(surge, {}), surge.regressors.size());
  surge.phi.col(0) *= 1e4;
  surge.phi.col(2) *= 1e-3;
  const ExcitationSummary after = Summarise(*Assess(surge, {}), surge.regressors.size());
  EXPECT_NEAR(after.condition, before.condition, 1e-6 * before.condition);
  for (std::size_t j = 0; j < before.variance_inflation.size(); ++j) {
    EXPECT_NEAR(after.variance_inflation[j], before.variance_inflation[j],
                1e-6 * before.variance_inflation[j]);
  }
}

TEST(ExcitationSummary, NamesTheInseparableCombination) {
  EquationProblem surge =
      SurgeIn({PropellerRegion::kFF, PropellerRegion::kFR, PropellerRegion::kRF});
  surge.phi.col(2) = 3.0 * surge.phi.col(1) + 1e-4 * surge.phi.col(2);
  const ExcitationSummary summary = Summarise(*Assess(surge, {}), surge.regressors.size());
  EXPECT_GT(summary.condition, 100.0);
  ASSERT_EQ(summary.least_separable.size(), 2u);
  EXPECT_EQ(summary.least_separable[0].regressor, 1u);
  EXPECT_EQ(summary.least_separable[1].regressor, 2u);
  // Columns of unit length are alike, so it is the difference of their coefficients that is open.
  EXPECT_NEAR(summary.least_separable[0].weight, -summary.least_separable[1].weight, 0.05);
}

TEST(ExcitationSummary, AnUnmovedColumnHasNoBoundedVariance) {
  const EquationProblem surge = SurgeIn({PropellerRegion::kFF});
  const ExcitationSummary summary = Summarise(*Assess(surge, {}), surge.regressors.size());
  for (std::size_t j = 0; j < surge.regressors.size(); ++j) {
    EXPECT_EQ(std::isinf(summary.variance_inflation[j]),
              surge.regressors[j].name.starts_with("r:"));
  }
}

}  // namespace
}  // namespace telltale
