#include "telltale/core/drift/change_equations.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "telltale/core/base/gauss_markov.hpp"

namespace telltale {
namespace {

constexpr double kWeak = 1e-9;

/// One term y = x' (change, another change, nuisance) + noise of unit variance.
ChangeEquations Term(const Eigen::Vector3d& x, double y) {
  return {x * x.transpose(), x * y, y * y, 1.0};
}

/// Many terms of random regressors, of which the last two go together.
ChangeEquations Terms(int count, const Eigen::Vector3d& truth, double noise, std::uint64_t seed) {
  WhiteSource white(seed, 1);
  ChangeEquations equations = ChangeEquations::OfZeros(3);
  for (int k = 0; k < count; ++k) {
    Eigen::Vector3d x(white(), white(), white());
    x[2] += 0.5 * x[0];
    equations.Add(Term(x, x.dot(truth) + noise * white()));
  }
  return equations;
}

MarginalChanges Marginal(const ChangeEquations& equations, double prior_precision) {
  return {equations, Eigen::VectorXd::Constant(1, prior_precision)};
}

TEST(MarginalChanges, FindsAChangeBesideAnyNuisance) {
  for (const double nuisance : {0.0, -20.0}) {
    const auto equations = Terms(200, {0.3, 0.0, nuisance}, 0.0, 1);
    EXPECT_NEAR(Marginal(equations, kWeak).Of(0).Value(), 0.3, 1e-6) << nuisance;
  }
}

TEST(MarginalChanges, PrecisionIsThatOfTheScatterOfReplicates) {
  constexpr int kReplicates = 400;
  double squares = 0.0;
  for (int i = 0; i < kReplicates; ++i) {
    const auto equations = Terms(50, {0.3, 0.0, 2.0}, 1.0, 100 + static_cast<std::uint64_t>(i));
    const ChangeInformation change = Marginal(equations, kWeak).Of(0);
    squares += std::pow(change.Value() - 0.3, 2) * change.precision;
  }
  // The mean square of 400 standard normal numbers is within 0.21 of one with 99.7 %.
  EXPECT_NEAR(squares / kReplicates, 1.0, 0.21);
}

TEST(MarginalChanges, AChangeLikeANuisanceIsKnownAsWellAsThatAtMost) {
  constexpr double kPriorPrecision = 25.0;
  ChangeEquations equations = ChangeEquations::OfZeros(2);
  for (int k = 0; k < 100000; ++k) {
    const Eigen::Vector2d x(1.0, 1.0);
    equations.Add({x * x.transpose(), 0.1 * x, 0.01, 1.0});
  }
  const MarginalChanges marginal(equations, Eigen::VectorXd::Constant(1, kPriorPrecision));
  EXPECT_NEAR(marginal.Of(0).precision, kPriorPrecision, 0.01);
}

TEST(MarginalChanges, ResidualVarianceIsThatOfTheNoiseWhateverExplainsTheRest) {
  for (const double noise : {1.0, 3.0}) {
    const auto equations = Terms(2000, {0.5, 0.0, -2.0}, noise, 7);
    // The variance of 2000 normal numbers is within a tenth of its expectation with 99.8 %.
    EXPECT_NEAR(Marginal(equations, kWeak).ResidualVariance() / (noise * noise), 1.0, 0.1) << noise;
  }
}

}  // namespace
}  // namespace telltale
