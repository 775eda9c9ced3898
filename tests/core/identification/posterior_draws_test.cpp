#include "telltale/core/identification/posterior_draws.hpp"

#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/made_up_identifications.hpp"
#include "support/physical_boat.hpp"

namespace telltale {
namespace {

using ::testing::ElementsAre;

/// Sample mean and covariance are the model's within Monte-Carlo error: of 40000 draws, 0.5 % of a
/// deviation at one sigma for a mean and 0.7 % of the deviations' product for a covariance.
TEST(DrawFromPosterior, HasTheModelsMeanAndCovariance) {
  const Identification model = MadeUpIdentification();
  constexpr Eigen::Index kDraws = 40000;
  const auto draws = DrawFromPosterior(model, kDraws, 5);
  ASSERT_TRUE(draws.has_value());
  const Eigen::VectorXd mean = draws->theta.rowwise().mean();
  const Eigen::MatrixXd centred = draws->theta.colwise() - mean;
  const Eigen::MatrixXd sample = centred * centred.transpose() / (kDraws - 1);
  for (Eigen::Index i = 0; i < sample.rows(); ++i) {
    if (i == 1) continue;  // not excited
    const double si = std::sqrt(model.covariance(i, i));
    EXPECT_NEAR(mean[i], model.coefficients[static_cast<std::size_t>(i)].estimate, 0.025 * si);
    for (Eigen::Index j = 0; j < sample.cols(); ++j) {
      if (j == 1) continue;
      const double sj = std::sqrt(model.covariance(j, j));
      EXPECT_NEAR(sample(i, j), model.covariance(i, j), 0.035 * si * sj) << i << ' ' << j;
    }
  }
}

// A model's covariance is that of parameters within their range, here of a time constant that is
// 1.25 of its standard errors from nothing: truncated once more, draws would scatter by 0.16.
TEST(DrawFromPosterior, ScattersAsThePhysicalFormsStandardErrors) {
  Identification model = testing::KnownPhysicalBoat(testing::PhysicalBoat(), 0.8);
  constexpr double kDelayError = 0.01;
  for (const FossenParameter delay : {FossenParameter::kCommandDelay, FossenParameter::kFixDelay}) {
    model.physical->covariance(At(delay), At(delay)) = kDelayError * kDelayError;
  }
  constexpr std::size_t kDraws = 10000;
  const auto draws = DrawFromPosterior(model, kDraws, 5);
  ASSERT_TRUE(draws.has_value());
  const Eigen::Map<const Eigen::VectorXd> tau(draws->time_constant_s.data(), kDraws);
  const double deviation = std::sqrt((tau.array() - tau.mean()).square().mean());
  // Four standard errors of a standard deviation of 1000 draws.
  EXPECT_NEAR(deviation, 0.2, 4.0 * 0.2 / std::sqrt(2000.0));
}

TEST(DrawFromPosterior, LeavesWhatIsNotExcitedAtZeroAndNamesIt) {
  const auto draws = DrawFromPosterior(MadeUpIdentification(), 50, 5);
  ASSERT_TRUE(draws.has_value());
  EXPECT_TRUE(draws->theta.row(1).isZero(0.0));
  EXPECT_THAT(draws->not_drawn, ElementsAre("SURGE vr"));
  EXPECT_EQ(draws->clipped, 0.0);
}

TEST(DrawFromPosterior, IsTheSeedsAlone) {
  const Identification model = MadeUpDynamicIdentification();
  const auto some = DrawFromPosterior(model, 10, 5);
  const auto more = DrawFromPosterior(model, 20, 5);
  EXPECT_EQ(some->theta, more->theta.leftCols(10));
  EXPECT_EQ(some->time_constant_s.back(), more->time_constant_s[9]);
  EXPECT_NE(some->theta, DrawFromPosterior(model, 10, 6)->theta);
}

/// Correlations 0.9, 0.9 and -0.9 are no covariance: eigenvalues 1.9, 1.9 and -0.8.
TEST(DrawFromPosterior, ClipsWhatIsNoCovarianceAndSaysSo) {
  Identification model = MadeUpIdentification();
  const auto n = model.covariance.rows();
  model.covariance = Eigen::MatrixXd::Identity(n, n);
  const auto set = [&](Eigen::Index i, Eigen::Index j, double value) {
    model.covariance(i, j) = model.covariance(j, i) = value;
  };
  set(0, 2, 0.9);
  set(0, 3, 0.9);
  set(2, 3, -0.9);
  const auto draws = DrawFromPosterior(model, 10, 5);
  ASSERT_TRUE(draws.has_value());
  EXPECT_NEAR(draws->clipped, 0.8 / 1.9, 1e-12);
  EXPECT_TRUE(draws->theta.allFinite());
}

/// ln tau has the relative standard error 0.05 as its deviation; 4000 draws hold that to 1.1 %.
TEST(DrawFromPosterior, DrawsAPositiveTimeConstant) {
  const auto draws = DrawFromPosterior(MadeUpDynamicIdentification(), 4000, 5);
  ASSERT_EQ(draws->time_constant_s.size(), 4000u);
  double squares = 0.0;
  for (const double tau : draws->time_constant_s) squares += std::pow(std::log(tau / 0.25), 2);
  EXPECT_NEAR(std::sqrt(squares / 4000.0), 0.05, 0.0025);
}

/// ln tau correlates with the coefficients as tau does: 1/2 with the first, and with the others
/// 1/2 of what the first has. 40000 draws: half a percent at one sigma, so 0.025 is five.
TEST(DrawFromPosterior, DrawsTheTimeConstantTogetherWithTheCoefficients) {
  const Identification model = MadeUpDynamicIdentification();
  constexpr Eigen::Index kDraws = 40000;
  const auto draws = DrawFromPosterior(model, kDraws, 5);
  ASSERT_TRUE(draws.has_value());
  EXPECT_EQ(draws->clipped, 0.0);
  const Eigen::VectorXd log_tau =
      Eigen::Map<const Eigen::VectorXd>(draws->time_constant_s.data(), kDraws).array().log();
  const Eigen::VectorXd apart = log_tau.array() - log_tau.mean();
  for (const Eigen::Index i : {0, 2, 9, 34}) {
    const Eigen::VectorXd row = draws->theta.row(i);
    const Eigen::VectorXd centred = row.array() - row.mean();
    const double expected =
        0.5 * model.covariance(0, i) / std::sqrt(model.covariance(0, 0) * model.covariance(i, i));
    EXPECT_NEAR(centred.dot(apart) / (centred.norm() * apart.norm()), expected, 0.025) << i;
  }
}

TEST(DrawFromPosterior, ATimeConstantThatIsHardlyKnownIsNotDrawn) {
  Identification model = MadeUpDynamicIdentification();
  model.thruster_time_constant->standard_error = std::numeric_limits<double>::infinity();
  const auto draws = DrawFromPosterior(model, 3, 5);
  EXPECT_THAT(draws->time_constant_s, ElementsAre(0.25, 0.25, 0.25));
  EXPECT_THAT(draws->not_drawn, ElementsAre("SURGE vr", "thruster time constant"));
}

TEST(DrawFromPosterior, RefusesAModelWithoutAnyBound) {
  Identification model = MadeUpIdentification();
  model.covariance.diagonal().setConstant(std::numeric_limits<double>::infinity());
  const auto draws = DrawFromPosterior(model, 3, 5);
  ASSERT_FALSE(draws.has_value());
  EXPECT_EQ(draws.error().subject, "draws");
}

}  // namespace
}  // namespace telltale
