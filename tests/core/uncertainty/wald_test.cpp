#include "telltale/core/uncertainty/wald.hpp"

#include <cmath>

#include <gtest/gtest.h>
#include <boost/random/normal_distribution.hpp>

#include "support/special_values.hpp"
#include "telltale/core/base/contract.hpp"
#include "telltale/core/base/linear_algebra/eigen_decompositions.hpp"
#include "telltale/core/base/random.hpp"

namespace telltale {
namespace {

Eigen::MatrixXd Normals(Eigen::Index rows, Eigen::Index columns, RandomEngine& engine) {
  boost::random::normal_distribution<double> normal(0.0, 1.0);
  Eigen::MatrixXd numbers(rows, columns);
  for (double& number : numbers.reshaped()) number = normal(engine);
  return numbers;
}

/// A covariance with strong correlations and standard deviations from 1 to 10^-4.
Eigen::MatrixXd Correlated(Eigen::Index p) {
  RandomEngine engine(17);
  const Eigen::MatrixXd root = Normals(p, p, engine) + Eigen::MatrixXd::Constant(p, p, 1.0);
  const Eigen::VectorXd scale = Eigen::VectorXd::LinSpaced(p, 0.0, -4.0).unaryExpr([](double e) {
    return std::pow(10.0, e);
  });
  const Eigen::MatrixXd scaled = scale.asDiagonal() * root;
  return scaled * scaled.transpose();
}

/// Chi-square critical values at 5 %, NIST/SEMATECH e-Handbook section 1.3.6.7.4: 3.841 for one
/// degree of freedom, 5.991 for two.
TEST(WaldTest, AgreesWithThePublishedTable) {
  const Estimates none{Eigen::VectorXd::Zero(1), Eigen::MatrixXd::Zero(1, 1)};
  const Estimates one{Eigen::VectorXd::Constant(1, std::sqrt(3.841) * 0.2),
                      Eigen::MatrixXd::Constant(1, 1, 0.04)};
  EXPECT_NEAR(TestEquality(one, none)->p_value, 0.05, 2e-5);
  const Estimates nothing{Eigen::VectorXd::Zero(2), Eigen::MatrixXd::Zero(2, 2)};
  const Estimates two{Eigen::Vector2d(std::sqrt(5.991), 0.0), Eigen::MatrixXd::Identity(2, 2)};
  EXPECT_NEAR(TestEquality(two, nothing)->p_value, 0.05, 2e-5);
}

/// With one estimate from g segments and the other known this is Hotelling's test: for one
/// coefficient Student's t of g - 1, 2.228 at 10 (the same handbook, 1.3.6.7.2).
TEST(WaldTest, WithFewSegmentsIsHotellingsTest) {
  const Estimates none{Eigen::VectorXd::Zero(1), Eigen::MatrixXd::Zero(1, 1)};
  const Estimates one{Eigen::VectorXd::Constant(1, 2.228), Eigen::MatrixXd::Identity(1, 1), 11};
  const auto test = TestEquality(one, none);
  EXPECT_NEAR(test->p_value, 0.05, 5e-5);
  EXPECT_NEAR(test->covariance_degrees_of_freedom, 10.0, 1e-9);
  EXPECT_NEAR(test->differences[0].p_value, 0.05, 5e-5);
}

/// Under the null, p values below 5 % come up 5 % of the time: 20,000 repeats leave 0.15 %.
TEST(WaldTest, HasItsSizeWhenCovariancesAreKnown) {
  const Eigen::MatrixXd Sigma = Correlated(6);
  const Eigen::MatrixXd root = Sigma.llt().matrixL();
  RandomEngine engine(1);
  double rejected = 0.0;
  for (int repeat = 0; repeat < 20000; ++repeat) {
    const Estimates first{root * Normals(6, 1, engine), Sigma};
    const Estimates second{2.0 * root * Normals(6, 1, engine), 4.0 * Sigma};
    rejected += TestEquality(first, second)->p_value < 0.05 ? 1.0 / 20000.0 : 0.0;
  }
  EXPECT_NEAR(rejected, 0.05, 0.005);
}

/// An estimate made of g segments, each with an estimate of its own, and its covariance.
Estimates FromSlices(const Eigen::VectorXd& truth, const Eigen::MatrixXd& root, std::size_t g,
                     RandomEngine& engine) {
  const auto count = static_cast<Eigen::Index>(g);
  const Eigen::MatrixXd each = (root * Normals(truth.size(), count, engine)).colwise() + truth;
  const Eigen::VectorXd mean = each.rowwise().mean();
  const Eigen::MatrixXd centred = each.colwise() - mean;
  const double n = static_cast<double>(g);
  return {mean, centred * centred.transpose() / ((n - 1.0) * n), g};
}

double RejectionRate(double shift, bool count_segments, int repeats) {
  const Eigen::MatrixXd root = Correlated(5).llt().matrixL();
  const Eigen::VectorXd truth = Eigen::VectorXd::Zero(5);
  const Eigen::VectorXd other = shift * root * Eigen::VectorXd::Ones(5) / std::sqrt(5.0);
  RandomEngine engine(2);
  double rejected = 0.0;
  for (int repeat = 0; repeat < repeats; ++repeat) {
    Estimates first = FromSlices(truth, root, 12, engine);
    Estimates second = FromSlices(other, 3.0 * root, 20, engine);
    if (!count_segments) first.clusters = second.clusters = 0;
    rejected += TestEquality(first, second)->p_value < 0.05 ? 1.0 / repeats : 0.0;
  }
  return rejected;
}

/// 12 and 20 segments, covariances that differ ninefold: the approximation keeps the size near 5 %
/// where chi-square rejects more than twice as often.
TEST(WaldTest, KeepsItsSizeWithFewSegments) {
  EXPECT_NEAR(RejectionRate(0.0, true, 4000), 0.05, 0.02);
  EXPECT_GT(RejectionRate(0.0, false, 4000), 0.12);
}

TEST(WaldTest, FindsLargerDifferencesMoreOften) {
  double last = RejectionRate(0.0, true, 1000);
  for (const double shift : {1.0, 2.0, 4.0}) {
    const double power = RejectionRate(shift, true, 1000);
    EXPECT_GT(power, last + 0.05) << shift;
    last = power;
  }
  EXPECT_GT(last, 0.95);
}

TEST(WaldTest, DoesNotDependOnUnits) {
  RandomEngine engine(9);
  const Eigen::MatrixXd root = Correlated(4).llt().matrixL();
  const Estimates first = FromSlices(Eigen::VectorXd::Ones(4), root, 15, engine);
  const Estimates second = FromSlices(Eigen::VectorXd::Zero(4), root, 15, engine);
  const Eigen::Vector4d units(1e6, 1.0, 1e-3, 57.3);
  const auto convert = [&](const Estimates& e) {
    return Estimates{units.asDiagonal() * e.theta,
                     units.asDiagonal() * e.covariance * units.asDiagonal(), e.clusters};
  };
  const auto plain = TestEquality(first, second);
  const auto converted = TestEquality(convert(first), convert(second));
  EXPECT_NEAR(converted->statistic, plain->statistic, 1e-8 * plain->statistic);
  EXPECT_NEAR(converted->p_value, plain->p_value, 1e-10);
  EXPECT_TRUE(converted->combination.isApprox(plain->combination, 1e-8));
}

/// Coefficients one of the models does not know stay out, wherever they stand.
TEST(WaldTest, ComparesOnlyWhatBothKnow) {
  Eigen::MatrixXd Sigma = Eigen::MatrixXd::Identity(3, 3);
  Sigma(1, 1) = kInfinity;
  const Estimates first{Eigen::Vector3d(0.0, 100.0, 3.0), Sigma};
  const Estimates second{Eigen::Vector3d(0.0, 0.0, 0.0), Eigen::MatrixXd::Identity(3, 3)};
  const auto test = TestEquality(first, second);
  ASSERT_EQ(test->degrees_of_freedom, 2u);
  EXPECT_NEAR(test->statistic, 4.5, 1e-12);
  EXPECT_EQ(test->differences[0].index, 2u);
  EXPECT_NEAR(test->differences[0].difference, 3.0, 1e-12);
  EXPECT_NEAR(test->differences[0].standard_error, std::sqrt(2.0), 1e-12);
  Sigma.diagonal().setConstant(kInfinity);
  EXPECT_FALSE(TestEquality({first.theta, Sigma}, second));
}

/// Two coefficients known only by their sum: each difference is within its error, their sum is not,
/// and the combination says so.
TEST(WaldTest, NamesTheCombinationThatDiffersMost) {
  Eigen::MatrixXd Sigma(2, 2);
  Sigma << 1.0, -0.99, -0.99, 1.0;
  const Estimates first{Eigen::Vector2d(0.5, 0.5), Sigma};
  const Estimates second{Eigen::Vector2d::Zero(), Eigen::MatrixXd::Zero(2, 2)};
  const auto test = TestEquality(first, second);
  EXPECT_NEAR(test->statistic, 1.0 / 0.02, 1e-9);  // (0.5 + 0.5)^2 over Var of the sum
  EXPECT_GT(test->differences[0].p_value, 0.5);
  EXPECT_LT(test->p_value, 1e-8);
  EXPECT_NEAR(test->combination[0], std::sqrt(0.5), 1e-9);
  EXPECT_NEAR(test->combination[1], std::sqrt(0.5), 1e-9);
}

/// A covariance of rank one tests one direction, not two.
TEST(WaldTest, CountsTheRankOfTheCovariance) {
  const Eigen::Vector2d direction(1.0, 2.0);
  const Estimates first{direction, 0.25 * direction * direction.transpose()};
  const Estimates second{Eigen::Vector2d::Zero(), Eigen::MatrixXd::Zero(2, 2)};
  const auto test = TestEquality(first, second);
  EXPECT_EQ(test->degrees_of_freedom, 1u);
  EXPECT_NEAR(test->statistic, 4.0, 1e-9);
}

TEST(WaldTest, RefusesWhatItCannotTest) {
  RandomEngine engine(3);
  const Eigen::MatrixXd root = Eigen::MatrixXd::Identity(5, 5);
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(5);
  const Estimates few = FromSlices(zero, root, 4, engine);
  const Estimates known{zero, Eigen::MatrixXd::Zero(5, 5)};
  const auto refused = TestEquality(few, known);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().reason.find("segments"), std::string::npos);
  EXPECT_FALSE(TestEquality(known, known));
  EXPECT_THROW(TestEquality({zero, root}, {Eigen::VectorXd::Zero(4), root}), ContractViolation);
}

}  // namespace
}  // namespace telltale
