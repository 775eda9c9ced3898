#include "uncertainty/segment_bootstrap.hpp"

#include <cmath>

#include <gtest/gtest.h>
#include <Eigen/QR>
#include <boost/random/normal_distribution.hpp>
#include <boost/random/uniform_int_distribution.hpp>

#include "simulation/yellowfish.hpp"
#include "support/discrete_boat.hpp"

namespace telltale {
namespace {

using Estimates = std::array<std::optional<EquationEstimate>, 3>;

constexpr std::size_t kSegmentRows = 50;

RegressionProblem NoisyProblem(double sigma, std::uint64_t seed) {
  const auto commands = testing::RandomCommands(
      3000, {PropellerRegion::kFF, PropellerRegion::kFR, PropellerRegion::kRF}, 7);
  RegressionProblem problem =
      BuildRegression(testing::DriveDiscrete(YellowfishTwin(), commands, kSegmentRows), {});
  RandomEngine engine(seed);
  boost::random::normal_distribution<double> noise(0.0, sigma);
  for (EquationProblem& equation : problem.equations) {
    for (double& value : equation.y) value += noise(engine);
  }
  return problem;
}

std::vector<ClusteredFit> FitsOf(const RegressionProblem& problem, const Estimates& estimates) {
  std::vector<ClusteredFit> fits;
  for (std::size_t j = 0; j < 3; ++j) fits.push_back(FitOf(problem.equations[j], *estimates[j]));
  return fits;
}

Estimates EstimateAll(const RegressionProblem& problem) {
  Estimates estimates;
  for (std::size_t j = 0; j < 3; ++j) {
    estimates[j] = EstimateOneStep(*Assess(problem.equations[j], {}));
  }
  return estimates;
}

TEST(SegmentBootstrap, GivesTheSameBitsForAnyThreadCount) {
  const auto problem = NoisyProblem(0.1, 1);
  const auto estimates = EstimateAll(problem);
  const auto one = BootstrapSegments(FitsOf(problem, estimates), {500, 42, 1});
  for (const std::size_t threads : {2u, 3u, 8u}) {
    const auto many = BootstrapSegments(FitsOf(problem, estimates), {500, 42, threads});
    EXPECT_TRUE((one.theta.array() == many.theta.array()).all());
  }
}

TEST(SegmentBootstrap, SeedsDiffer) {
  const auto problem = NoisyProblem(0.1, 1);
  const auto estimates = EstimateAll(problem);
  const auto one = BootstrapSegments(FitsOf(problem, estimates), {100, 1, 1});
  const auto two = BootstrapSegments(FitsOf(problem, estimates), {100, 2, 1});
  EXPECT_FALSE((one.theta.array() == two.theta.array()).any());
}

/// The law behind the fast form: a replicate is the least-squares fit of the stacked drawn rows.
TEST(SegmentBootstrap, ReplicateIsTheFitOfTheDrawnRows) {
  const auto problem = NoisyProblem(0.1, 1);
  const auto estimates = EstimateAll(problem);
  const auto fast = BootstrapSegments(FitsOf(problem, estimates), {100, 9, 2});
  ASSERT_EQ(fast.failures, 0u);

  const std::size_t segments = problem.equations[0].clusters.size();
  for (const std::size_t i : {0u, 57u, 99u}) {
    RandomEngine engine = RandomEngine::Stream(9, i);
    boost::random::uniform_int_distribution<std::size_t> pick(0, segments - 1);
    std::vector<std::size_t> drawn;
    for (std::size_t draw = 0; draw < segments; ++draw) drawn.push_back(pick(engine));

    Eigen::Index first = 0;
    for (const EquationProblem& equation : problem.equations) {
      Eigen::Index rows = 0;
      for (const std::size_t s : drawn) {
        rows += static_cast<Eigen::Index>(equation.clusters[s].size());
      }
      Eigen::MatrixXd phi(rows, equation.phi.cols());
      Eigen::VectorXd y(rows);
      Eigen::Index at = 0;
      for (const std::size_t s : drawn) {
        const auto begin = static_cast<Eigen::Index>(equation.clusters[s].begin);
        const auto count = static_cast<Eigen::Index>(equation.clusters[s].size());
        phi.middleRows(at, count) = equation.phi.middleRows(begin, count);
        y.segment(at, count) = equation.y.segment(begin, count);
        at += count;
      }
      const Eigen::VectorXd direct = phi.colPivHouseholderQr().solve(y);
      const Eigen::VectorXd replicate =
          fast.theta.col(static_cast<Eigen::Index>(i)).segment(first, direct.size());
      EXPECT_TRUE(replicate.isApprox(direct, 1e-8)) << Name(equation.equation);
      first += direct.size();
    }
  }
}

/// With white noise and many segments the bootstrap's standard errors agree with the textbook's. 60
/// segments and 2000 replicates leave about 10 % of scatter per coefficient; their mean ratio much
/// less.
TEST(SegmentBootstrap, AgreesWithResidualCovarianceUnderWhiteNoise) {
  const auto problem = NoisyProblem(0.1, 3);
  const auto estimates = EstimateAll(problem);
  const Eigen::MatrixXd covariance =
      Covariance(BootstrapSegments(FitsOf(problem, estimates), {2000, 5, 2}));
  double log_ratio = 0.0;
  Eigen::Index place = 0;
  for (const auto& estimate : estimates) {
    const Eigen::MatrixXd textbook =
        estimate->residual_variance * estimate->basis * estimate->basis.transpose();
    for (Eigen::Index j = 0; j < textbook.rows(); ++j, ++place) {
      const double ratio = std::sqrt(covariance(place, place) / textbook(j, j));
      EXPECT_GT(ratio, 0.6);
      EXPECT_LT(ratio, 1.6);
      log_ratio += std::log(ratio);
    }
  }
  EXPECT_NEAR(log_ratio / static_cast<double>(place), 0.0, 0.1);
}

/// A boat that reversed in one segment only cannot be refitted from draws that miss that segment.
TEST(SegmentBootstrap, CountsDrawsThatCannotBeSolved) {
  auto commands = testing::RandomCommands(1000, {PropellerRegion::kFF}, 7);
  for (std::size_t k = 500; k < 550; ++k) commands[k].starboard = (k % 3 == 0) ? -0.3 : -0.9;
  const auto problem =
      BuildRegression(testing::DriveDiscrete(YellowfishTwin(), commands, kSegmentRows), {});
  const auto estimates = EstimateAll(problem);
  const auto replicates = BootstrapSegments(FitsOf(problem, estimates), {1000, 1, 1});
  // P(one of 20 segments is never drawn) = 0.95^20 = 0.358; four sigmas of 1000 draws are 0.061.
  EXPECT_NEAR(static_cast<double>(replicates.failures) / 1000.0, 0.358, 0.061);
  EXPECT_EQ(static_cast<std::size_t>(replicates.theta.cols()) + replicates.failures, 1000u);
}

}  // namespace
}  // namespace telltale
