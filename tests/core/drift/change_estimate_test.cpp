#include "telltale/core/drift/change_estimate.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "telltale/core/base/gauss_markov.hpp"

namespace telltale {
namespace {

constexpr double kForgetting = 0.98;
constexpr double kSets = (1.0 + kForgetting) / (1.0 - kForgetting);  // that count for a variance

const Eigen::VectorXd kWeakPrior = Eigen::VectorXd::Constant(2, 1e-6);

/// One row y = x' (change, nuisance) + noise as normal equations.
NormalEquations Row(double first, double second, double y) {
  const Eigen::Vector2d x(first, second);
  return {x * x.transpose(), x * y};
}

/// An estimate after so many rows of random regressors and noise.
ChangeEstimate After(int rows, double change, double nuisance, double noise, std::uint64_t seed) {
  ChangeEstimate estimate(kWeakPrior, kForgetting);
  WhiteSource white(seed, 1);
  for (int k = 0; k < rows; ++k) {
    const double first = white();
    const double second = white();
    estimate.Add(Row(first, second, first * change + second * nuisance + noise * white()));
  }
  return estimate;
}

TEST(ChangeEstimate, IsZeroBeforeAnythingIsKnown) {
  EXPECT_EQ(ChangeEstimate(kWeakPrior, kForgetting).Value(), 0.0);
}

TEST(ChangeEstimate, FindsAChangeBesideANuisance) {
  EXPECT_NEAR(After(500, 0.3, -2.0, 0.0, 1).Value(), 0.3, 1e-4);
}

TEST(ChangeEstimate, StandardErrorIsTheScatterOfReplicatesWhateverTheNoise) {
  for (const double noise : {0.1, 10.0}) {
    constexpr int kReplicates = 400;
    double squares = 0.0;
    for (int i = 0; i < kReplicates; ++i) {
      const ChangeEstimate estimate = After(400, 1.0, 1.0, noise, 100 + i);
      squares += std::pow((estimate.Value() - 1.0) / estimate.StandardError(), 2);
    }
    // The mean square of 400 standard normal numbers is within 0.21 of one with 99.7 %; the rest
    // is for the variance, which is estimated from some hundred rows.
    EXPECT_NEAR(squares / kReplicates, 1.0, 0.3) << noise;
  }
}

TEST(ChangeEstimate, ForgetsAsLongAgoAsItSays) {
  ChangeEstimate estimate(kWeakPrior, kForgetting);
  for (int k = 0; k < 1000; ++k) estimate.Add(Row(1.0, 0.0, 0.0));
  for (int k = 0; k < 100; ++k) estimate.Add(Row(1.0, 0.0, 1.0));
  EXPECT_NEAR(estimate.Value(), 1.0 - std::pow(kForgetting, 100), 1e-6);
  EXPECT_NEAR(estimate.Count(), 0.5 * (kSets + 1.0), 1e-6);
}

TEST(ChangeEstimate, WhatCannotBeToldFromANuisanceIsAsUncertainAsTheNuisance) {
  constexpr double kNuisanceSd = 0.2;
  Eigen::VectorXd precision(2);
  precision << 1e-6, 1.0 / (kNuisanceSd * kNuisanceSd);
  ChangeEstimate estimate(precision, kForgetting);
  for (int k = 0; k < 1000; ++k) estimate.Add(Row(1.0, 1.0, 0.1));
  EXPECT_NEAR(estimate.StandardError(), kNuisanceSd, 0.01 * kNuisanceSd);
}

}  // namespace
}  // namespace telltale
