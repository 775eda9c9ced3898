#include "telltale/core/estimation/regression/excitation.hpp"

#include <gtest/gtest.h>

#include "support/discrete_boat.hpp"
#include "telltale/core/paper/yellowfish.hpp"

namespace telltale {
namespace {

std::array<EquationProblem, 3> ProblemsIn(const std::vector<PropellerRegion>& regions,
                                          const RegressionOptions& options) {
  return BuildRegression(testing::DriveDiscrete(YellowfishTwin(),
                                                testing::RandomCommands(2000, regions, 4), 50),
                         options)
      .equations;
}

/// A law: what is assessed together is assessed as it is alone, in either parameterization.
TEST(Assess, SaysOfEquationsTogetherWhatItSaysOfEach) {
  for (const Parameterization named : {Parameterization::kPropeller, Parameterization::kPaper}) {
    RegressionOptions options;
    options.parameterization = named;
    const auto problems =
        ProblemsIn({PropellerRegion::kFF, PropellerRegion::kFR, PropellerRegion::kRF}, options);
    const auto together = Assess(problems, {});
    for (std::size_t j = 0; j < problems.size(); ++j) {
      const auto alone = Assess(problems[j], {});
      ASSERT_TRUE(alone.has_value() && together[j].has_value());
      EXPECT_EQ(together[j]->equation, kEquations[j]);
      EXPECT_EQ(together[j]->excited, alone->excited);
      EXPECT_EQ(together[j]->rank, alone->rank);
      EXPECT_TRUE(together[j]->singular_values.isApprox(alone->singular_values, 1e-12));
      EXPECT_TRUE(together[j]->factor.z.isApprox(alone->factor.z, 1e-9));
      EXPECT_NEAR(together[j]->factor.rho, alone->factor.rho, 1e-9);
      EXPECT_EQ(together[j]->factor.rows, alone->factor.rows);
    }
  }
}

/// Rows in which the boat never turns.
TEST(Assess, RefusesEachEquationInItsOwnName) {
  auto problems = ProblemsIn({PropellerRegion::kFF}, {});
  for (const std::size_t j : {1u, 2u}) {
    for (std::size_t column = 0; column < problems[j].regressors.size(); ++column) {
      if (problems[j].regressors[column].name != "r") continue;
      problems[j].phi.col(static_cast<Eigen::Index>(column)).setZero();
    }
  }
  const auto assessed = Assess(problems, {});
  ASSERT_FALSE(assessed[1].has_value() || assessed[2].has_value());
  EXPECT_EQ(assessed[1].error().subject, "SWAY");
  EXPECT_EQ(assessed[2].error().subject, "YAW");
}

}  // namespace
}  // namespace telltale
