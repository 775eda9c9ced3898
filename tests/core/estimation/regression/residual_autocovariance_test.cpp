#include "telltale/core/estimation/regression/residual_autocovariance.hpp"

#include <algorithm>
#include <random>

#include <Eigen/Eigenvalues>

#include <gtest/gtest.h>
#include <boost/random/normal_distribution.hpp>

#include "telltale/core/base/random.hpp"

namespace telltale {
namespace {

/// Two runs, of nine and six windows.
const std::vector<RowRange> kTwoRuns = {{0, 9}, {9, 15}};

Eigen::MatrixXd DrawnColumns(Eigen::Index columns, unsigned seed) {
  std::mt19937 engine(seed);
  std::normal_distribution<double> normal;
  return Eigen::MatrixXd::NullaryExpr(15, columns, [&] { return normal(engine); });
}

Eigen::MatrixXd DenseCovariance(const Eigen::VectorXd& autocovariance) {
  Eigen::MatrixXd V = Eigen::MatrixXd::Zero(15, 15);
  for (const RowRange& run : kTwoRuns) {
    for (std::size_t i = run.begin; i < run.end; ++i) {
      for (std::size_t j = run.begin; j < run.end; ++j) {
        const auto lag = static_cast<Eigen::Index>(i > j ? i - j : j - i);
        if (lag >= autocovariance.size()) continue;
        V(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = autocovariance[lag];
      }
    }
  }
  return V;
}

/// Mean of the entries of a dense covariance that stand l windows apart within a run.
double MeanApart(const Eigen::MatrixXd& covariance, Eigen::Index l) {
  double sum = 0.0;
  double pairs = 0.0;
  for (const RowRange& run : kTwoRuns) {
    for (auto i = static_cast<Eigen::Index>(run.begin); i + l < static_cast<Eigen::Index>(run.end);
         ++i) {
      sum += covariance(i, i + l);
      pairs += 1.0;
    }
  }
  return sum / pairs;
}

TEST(RunsOf, EndWhereAPlaceIsMissing) {
  const std::vector<std::size_t> places = {4, 9, 14, 20, 25, 40};
  const auto runs = RunsOf(places, 5);
  ASSERT_EQ(runs.size(), 3U);
  EXPECT_EQ(runs[0].begin, 0U);
  EXPECT_EQ(runs[0].end, 3U);
  EXPECT_EQ(runs[1].begin, 3U);
  EXPECT_EQ(runs[1].end, 5U);
  EXPECT_EQ(runs[2].begin, 5U);
  EXPECT_EQ(runs[2].end, 6U);
}

/// x(k) = f x(k - 1) + white: n values say as much of the mean as n (1 - f) / (1 + f) independent
/// ones. 40,000 draws know that to a few per cent.
TEST(RowsPerIndependentRow, IsThatOfAnAutoregressiveProcess) {
  for (const double f : {0.0, 0.5, 0.8}) {
    RandomEngine engine(3);
    boost::random::normal_distribution<double> white(0.0, 1.0);
    Eigen::VectorXd x(40000);
    x[0] = white(engine);
    for (Eigen::Index k = 1; k < x.size(); ++k) x[k] = f * x[k - 1] + white(engine);
    const std::vector<RowRange> one_run = {{0, 40000}};
    const double expected = (1.0 + f) / (1.0 - f);
    EXPECT_NEAR(RowsPerIndependentRow(x, one_run), expected, 0.08 * expected) << f;
    // Cut into runs the same process gives the same value.
    std::vector<RowRange> runs;
    for (std::size_t k = 0; k < 40000; k += 200) runs.push_back({k, k + 200});
    EXPECT_NEAR(RowsPerIndependentRow(x, runs), expected, 0.1 * expected) << f;
  }
}

TEST(RowsPerIndependentRow, NeverPromisesMoreThanThereAre) {
  Eigen::VectorXd x(1000);
  for (Eigen::Index k = 0; k < x.size(); ++k) x[k] = k % 2 == 0 ? 1.0 : -1.0;
  const std::vector<RowRange> run = {{0, 1000}};
  EXPECT_EQ(RowsPerIndependentRow(x, run), 1.0);
  EXPECT_EQ(RowsPerIndependentRow(Eigen::VectorXd::Zero(1000), run), 1.0);
}

TEST(ResidualCorrelation, AutocovarianceIsTheMeanProductWithinRuns) {
  const Eigen::VectorXd residual = DrawnColumns(1, 1);
  const Eigen::VectorXd found = Autocovariance(kTwoRuns, residual, 12);
  const Eigen::MatrixXd products = residual * residual.transpose();
  for (Eigen::Index l = 0; l < 9; ++l) EXPECT_NEAR(found[l], MeanApart(products, l), 1e-12);
  EXPECT_EQ(found.tail(3), Eigen::VectorXd::Zero(3));  // longer than the longest run
}

double LeastVariance(const Eigen::VectorXd& autocovariance) {
  const Eigen::MatrixXd V = DenseCovariance(autocovariance);
  return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(V).eigenvalues()[0];
}

// What changes slowly, in runs as short as itself: means over few pairs are of no process at all.
TEST(ResidualCorrelation, DefiniteAutocovarianceMakesNoVarianceNegative) {
  constexpr std::size_t kLags = 12;
  bool some_means_do = false;
  for (unsigned seed = 1; seed <= 50; ++seed) {
    Eigen::VectorXd residual = DrawnColumns(1, seed);
    for (Eigen::Index k = 1; k < residual.size(); ++k) residual[k] += 0.9 * residual[k - 1];
    const Eigen::VectorXd definite = DefiniteAutocovariance(kTwoRuns, residual, kLags);
    EXPECT_GT(LeastVariance(definite), -1e-12 * definite[0]) << seed;
    EXPECT_NEAR(definite[0], residual.squaredNorm() / 15.0, 1e-12 * definite[0]);
    some_means_do |= LeastVariance(Autocovariance(kTwoRuns, residual, kLags)) < 0.0;
  }
  EXPECT_TRUE(some_means_do);
}

TEST(ResidualCorrelation, CorrelatingIsMultiplyingByTheCovariance) {
  const Eigen::VectorXd autocovariance = (Eigen::VectorXd(4) << 2.0, 1.1, 0.4, -0.1).finished();
  const Eigen::MatrixXd X = DrawnColumns(3, 2);
  const Eigen::MatrixXd expected = DenseCovariance(autocovariance) * X;
  EXPECT_LT((Correlate(kTwoRuns, autocovariance, X) - expected).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(ResidualCorrelation, AfterAFitIsTheCovarianceOfItsResiduals) {
  const Eigen::VectorXd autocovariance = (Eigen::VectorXd(4) << 2.0, 1.1, 0.4, -0.1).finished();
  const Eigen::MatrixXd G = DrawnColumns(3, 3);
  const Eigen::MatrixXd Z = G + 0.3 * DrawnColumns(3, 4);
  const Eigen::Matrix3d moments = Z.transpose() * G;
  const Eigen::MatrixXd inverse = moments.inverse();
  const Eigen::MatrixXd response = G * inverse;
  const Eigen::MatrixXd fits = response * Z.transpose();
  const Eigen::MatrixXd keeps = Eigen::MatrixXd::Identity(15, 15) - fits;
  const Eigen::MatrixXd kept = keeps * DenseCovariance(autocovariance);
  const Eigen::MatrixXd expected = kept * keeps.transpose();
  const Eigen::VectorXd left = AutocovarianceAfterFit(kTwoRuns, autocovariance, response, Z, 6);
  for (Eigen::Index l = 0; l < 6; ++l) EXPECT_NEAR(left[l], MeanApart(expected, l), 1e-11) << l;
}

}  // namespace
}  // namespace telltale
