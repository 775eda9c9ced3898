#include "telltale/core/uncertainty/bootstrap.hpp"

#include <cmath>

#include <gtest/gtest.h>
#include <boost/random/exponential_distribution.hpp>
#include <boost/random/normal_distribution.hpp>

#include "support/discrete_boat.hpp"
#include "telltale/core/base/linear_algebra/eigen_decompositions.hpp"
#include "telltale/core/paper/yellowfish.hpp"
#include "telltale/core/uncertainty/timeline.hpp"

namespace telltale {
namespace {

using OneStepEquations = std::array<std::optional<EquationEstimate>, 3>;

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

std::vector<ClusteredFit> FitsOf(const RegressionProblem& problem,
                                 const OneStepEquations& estimates) {
  std::vector<ClusteredFit> fits;
  for (std::size_t j = 0; j < 3; ++j) fits.push_back(FitOf(problem.equations[j], *estimates[j]));
  return fits;
}

OneStepEquations EstimateAll(const RegressionProblem& problem) {
  OneStepEquations estimates;
  for (std::size_t j = 0; j < 3; ++j) {
    estimates[j] = EstimateOneStep(*Assess(problem.equations[j], {}));
  }
  return estimates;
}

TEST(SliceBootstrap, GivesTheSameBitsForAnyThreadCount) {
  const auto problem = NoisyProblem(0.1, 1);
  const auto estimates = EstimateAll(problem);
  const auto one = Bootstrap(FitsOf(problem, estimates), {500, 42, 1});
  for (const std::size_t threads : {2u, 3u, 8u}) {
    const auto many = Bootstrap(FitsOf(problem, estimates), {500, 42, threads});
    EXPECT_TRUE((one.theta.array() == many.theta.array()).all());
  }
}

TEST(SliceBootstrap, SeedsDiffer) {
  const auto problem = NoisyProblem(0.1, 1);
  const auto estimates = EstimateAll(problem);
  const auto one = Bootstrap(FitsOf(problem, estimates), {100, 1, 1});
  const auto two = Bootstrap(FitsOf(problem, estimates), {100, 2, 1});
  EXPECT_FALSE((one.theta.array() == two.theta.array()).any());
}

/// The law behind the fast form: a replicate is the least-squares fit of the stacked drawn rows.
TEST(SliceBootstrap, ReplicateIsTheFitOfTheDrawnRows) {
  const auto problem = NoisyProblem(0.1, 1);
  const auto estimates = EstimateAll(problem);
  const auto fast = Bootstrap(FitsOf(problem, estimates), {100, 9, 2});
  ASSERT_EQ(fast.failures, 0u);

  const std::size_t slices = problem.equations[0].clusters.size();
  for (const std::size_t i : {0u, 57u, 99u}) {
    RandomEngine engine = RandomEngine::Stream(9, i);
    std::vector<std::size_t> drawn;
    for (std::size_t draw = 0; draw < slices; ++draw) {
      drawn.push_back(DrawBelow(engine, slices));
    }

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

/// The same law for moving blocks, drawn as the plan says, every block walked row by row.
TEST(BlockBootstrap, ReplicateIsTheFitOfTheDrawnRows) {
  const auto problem = NoisyProblem(0.1, 1);
  const auto fits = FitsOf(problem, EstimateAll(problem));
  BootstrapOptions options{100, 9, 2, Resampling::kMovingBlocks};
  options.block_length = 40;
  const auto fast = Bootstrap(fits, options);
  ASSERT_EQ(fast.failures, 0u);

  const Timeline timeline = TimelineOf(fits);
  ASSERT_EQ(timeline.runs.size(), 1u);
  const std::size_t rows = timeline.instants.size();
  ASSERT_EQ(fast.draws, (rows + 20) / 40);
  for (const std::size_t i : {0u, 63u}) {
    RandomEngine engine = RandomEngine::Stream(9, i);
    std::vector<Eigen::Index> drawn;
    for (std::size_t draw = 0; draw < fast.draws; ++draw) {
      const std::size_t start = DrawBelow(engine, rows);
      for (std::size_t t = 0; t < 40; ++t) {
        drawn.push_back(static_cast<Eigen::Index>((start + t) % rows));
      }
    }
    Eigen::Index first = 0;
    for (const EquationProblem& equation : problem.equations) {
      const Eigen::VectorXd direct = Eigen::MatrixXd(equation.phi(drawn, Eigen::all))
                                         .colPivHouseholderQr()
                                         .solve(Eigen::VectorXd(equation.y(drawn)));
      const Eigen::VectorXd replicate =
          fast.theta.col(static_cast<Eigen::Index>(i)).segment(first, direct.size());
      EXPECT_TRUE(replicate.isApprox(direct, 1e-8)) << Name(equation.equation);
      first += direct.size();
    }
  }
}

TEST(BlockBootstrap, GivesTheSameBitsForAnyThreadCount) {
  const auto problem = NoisyProblem(0.1, 1);
  const auto fits = FitsOf(problem, EstimateAll(problem));
  for (const Resampling resampling : {Resampling::kMovingBlocks, Resampling::kSlices}) {
    BootstrapOptions options{500, 42, 1, resampling, IntervalMethod::kStudentized};
    const auto one = Bootstrap(fits, options);
    for (const std::size_t threads : {2u, 7u}) {
      options.threads = threads;
      const auto many = Bootstrap(fits, options);
      EXPECT_TRUE((one.theta.array() == many.theta.array()).all());
      EXPECT_TRUE((one.standard_errors.array() == many.standard_errors.array()).all());
    }
  }
}

/// A fit of the mean of a series: W is a column of ones, scaled.
ClusteredFit MeanOf(const Eigen::VectorXd& series, std::size_t slices) {
  const auto rows = static_cast<std::size_t>(series.size());
  ClusteredFit fit;
  fit.W = Eigen::VectorXd::Constant(series.size(), 1.0 / std::sqrt(static_cast<double>(rows)));
  fit.theta = Eigen::VectorXd::Constant(1, series.mean());
  fit.residual = series.array() - series.mean();
  fit.basis = Eigen::MatrixXd::Constant(1, 1, 1.0 / std::sqrt(static_cast<double>(rows)));
  fit.estimable = {true};
  for (std::size_t s = 0; s < slices; ++s) {
    fit.clusters.push_back({s * rows / slices, (s + 1) * rows / slices});
  }
  for (std::size_t i = 0; i < rows; ++i) fit.instants.push_back(i);
  return fit;
}

/// Var(mean) of n rows of AR(1) is sigma^2 / (n (1 - rho)^2) for white noise of variance sigma^2;
/// blocks of length l see all of it but the share 2 rho / (1 - rho^2) / l (Politis and White 2004).
/// The ratio over 40 series scatters by 2 %.
TEST(BlockBootstrap, GivesTheVarianceOfTheMeanOfAnAutoregression) {
  constexpr double kRho = 0.7;
  constexpr Eigen::Index kRows = 4000;
  double sum = 0.0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    RandomEngine engine(seed);
    boost::random::normal_distribution<double> normal(0.0, 1.0);
    Eigen::VectorXd series(kRows);
    double value = normal(engine) / std::sqrt(1.0 - kRho * kRho);
    for (double& element : series) {
      element = value;
      value = kRho * value + normal(engine);
    }
    BootstrapOptions options{2000, seed, 1, Resampling::kMovingBlocks};
    options.block_length = 50;
    sum += Covariance(Bootstrap({MeanOf(series, 1)}, options))(0, 0);
  }
  const double theory = 1.0 / (kRows * std::pow(1.0 - kRho, 2));
  const double seen = 1.0 - 2.0 * kRho / (1.0 - kRho * kRho) / 50.0;
  EXPECT_NEAR(sum / 40.0 / theory, seen, 0.06);
}

/// The cluster standard error of a mean of equal slices is sqrt(sum of squared segment means) /
/// slices, by hand; that of blocks of one instant the textbook's.
TEST(Bootstrap, StandardErrorOfTheEstimateIsTheClusterFormula) {
  RandomEngine engine(4);
  boost::random::normal_distribution<double> normal(0.0, 1.0);
  Eigen::VectorXd series(600);
  for (double& value : series) value = normal(engine);
  const ClusteredFit fit = MeanOf(series, 20);
  const auto slices =
      Bootstrap({fit}, {100, 1, 1, Resampling::kSlices, IntervalMethod::kStudentized});
  const Eigen::VectorXd means = fit.residual.reshaped(30, 20).colwise().mean();
  EXPECT_NEAR(slices.standard_error[0], means.norm() / 20.0, 1e-12);

  BootstrapOptions options{100, 1, 1, Resampling::kMovingBlocks, IntervalMethod::kStudentized};
  options.block_length = 1;
  EXPECT_NEAR(Bootstrap({fit}, options).standard_error[0], fit.residual.norm() / 600.0, 1e-12);
}

/// Every replicate's standard error is the cluster formula about its own estimate.
TEST(Bootstrap, StandardErrorsOfReplicatesAreThoseOfTheirRows) {
  RandomEngine engine(8);
  boost::random::normal_distribution<double> normal(0.0, 1.0);
  Eigen::VectorXd series(100);
  for (double& value : series) value = normal(engine);
  const auto replicates = Bootstrap({MeanOf(series, 10)},
                                    {100, 3, 1, Resampling::kSlices, IntervalMethod::kStudentized});
  for (const std::size_t i : {0u, 99u}) {
    RandomEngine draw = RandomEngine::Stream(3, i);
    Eigen::VectorXd means(10);
    for (double& mean : means) {
      mean = series.segment(static_cast<Eigen::Index>(10 * DrawBelow(draw, 10)), 10).mean();
    }
    const auto column = static_cast<Eigen::Index>(i);
    EXPECT_NEAR(replicates.theta(0, column), means.mean(), 1e-12);
    EXPECT_NEAR(replicates.standard_errors(0, column),
                (means.array() - means.mean()).matrix().norm() / 10.0, 1e-12);
  }
}

/// How often the interval of the mean of 20 exponential slices misses below and above the truth.
struct Misses {
  double below = 0.0;  // the whole interval lies below the truth
  double above = 0.0;
};

Misses MissesOf(IntervalMethod method) {
  constexpr std::uint64_t kRepeats = 2000;
  Misses misses;
  for (std::uint64_t seed = 1; seed <= kRepeats; ++seed) {
    RandomEngine engine(seed);
    boost::random::exponential_distribution<double> exponential(1.0);
    Eigen::VectorXd series(20);
    for (double& value : series) value = exponential(engine);
    const auto replicates =
        Bootstrap({MeanOf(series, 20)}, {1000, seed, 1, Resampling::kSlices, method});
    const Interval interval = Intervals(replicates, method, 0.9).front();
    misses.below += interval.upper < 1.0 ? 1.0 / kRepeats : 0.0;
    misses.above += interval.lower > 1.0 ? 1.0 / kRepeats : 0.0;
  }
  return misses;
}

/// A skewed estimate from few slices, 5 % to be missed on either side. Percentiles are
/// first-order correct only and miss far too often where the tail is long; BCa mends part of it and
/// studentized intervals most. 2000 repeats leave a standard deviation of 0.5 % to each rate. Why:
/// Hall, "The Bootstrap and Edgeworth Expansion" (1992), chapter 3.
TEST(Bootstrap, StudentizedAndBcaIntervalsMendTheCoverageOfSkewedEstimates) {
  const Misses percentile = MissesOf(IntervalMethod::kPercentile);
  const Misses bca = MissesOf(IntervalMethod::kBca);
  const Misses studentized = MissesOf(IntervalMethod::kStudentized);
  EXPECT_GT(percentile.below, 0.09);
  EXPECT_LT(bca.below, percentile.below - 0.01);
  EXPECT_NEAR(studentized.below, 0.05, 0.03);
  EXPECT_NEAR(studentized.above, 0.05, 0.02);
  EXPECT_NEAR(studentized.below + studentized.above, 0.10, 0.03);
}

/// Two regressors, normal errors shared within each of 25 slices: the exact distribution of the
/// estimate given the slices is normal, and bounds at 95 % must hold it that often. 1000 repeats
/// leave 0.7 %; percentiles of 25 slices are known to fall short by a few percent.
TEST(Bootstrap, StudentizedIntervalsCoverALinearModelWithFewSegments) {
  constexpr std::uint64_t kRepeats = 1000;
  constexpr Eigen::Index kSlices = 25;
  constexpr Eigen::Index kRowsEach = 8;
  double covered = 0.0;
  double percentile_covered = 0.0;
  for (std::uint64_t seed = 1; seed <= kRepeats; ++seed) {
    RandomEngine engine(seed);
    boost::random::normal_distribution<double> normal(0.0, 1.0);
    Eigen::MatrixXd phi(kSlices * kRowsEach, 2);
    for (double& value : phi.reshaped()) value = normal(engine);
    Eigen::VectorXd y = phi * Eigen::Vector2d(1.0, -2.0);
    ClusteredFit fit;
    for (Eigen::Index s = 0; s < kSlices; ++s) {
      const double shared = normal(engine);
      const auto first = static_cast<std::size_t>(s * kRowsEach);
      fit.clusters.push_back({first, first + kRowsEach});
      for (Eigen::Index i = s * kRowsEach; i < (s + 1) * kRowsEach; ++i) {
        phi(i, 1) += shared;  // the regressor too has a part of its segment
        y[i] += shared * -2.0 + normal(engine);
      }
      y.segment(s * kRowsEach, kRowsEach).array() += normal(engine);
    }
    const Eigen::Matrix2d normal_matrix = phi.transpose() * phi;
    const Eigen::Matrix2d R = normal_matrix.llt().matrixU();
    fit.basis = R.inverse();
    fit.W = phi * fit.basis;
    fit.theta = fit.basis * (fit.W.transpose() * y);
    fit.residual = y - phi * fit.theta;
    fit.estimable = {true, true};
    const auto replicates =
        Bootstrap({fit}, {1000, seed, 1, Resampling::kSlices, IntervalMethod::kStudentized});
    const Interval studentized = Intervals(replicates, IntervalMethod::kStudentized, 0.95)[1];
    const Interval percentile = Intervals(replicates, IntervalMethod::kPercentile, 0.95)[1];
    const auto holds = [](const Interval& i) { return i.lower <= -2.0 && -2.0 <= i.upper; };
    covered += holds(studentized) ? 1.0 / kRepeats : 0.0;
    percentile_covered += holds(percentile) ? 1.0 / kRepeats : 0.0;
  }
  EXPECT_NEAR(covered, 0.95, 0.025);
  EXPECT_LT(percentile_covered, covered);
}

/// Nothing to go by, nothing ruled out: a coefficient without any residual has no standard error.
TEST(Bootstrap, StudentizedIntervalsOfAnExactFitAreUnbounded) {
  const auto replicates = Bootstrap({MeanOf(Eigen::VectorXd::Ones(40), 8)},
                                    {100, 1, 1, Resampling::kSlices, IntervalMethod::kStudentized});
  EXPECT_TRUE(std::isinf(Intervals(replicates, IntervalMethod::kStudentized, 0.95)[0].upper));
}

/// With white noise and many slices the bootstrap's standard errors agree with the textbook's. 60
/// slices and 2000 replicates leave about 10 % of scatter per coefficient; their mean ratio much
/// less.
TEST(SliceBootstrap, AgreesWithResidualCovarianceUnderWhiteNoise) {
  const auto problem = NoisyProblem(0.1, 3);
  const auto estimates = EstimateAll(problem);
  const Eigen::MatrixXd covariance =
      Covariance(Bootstrap(FitsOf(problem, estimates), {2000, 5, 2}));
  double log_ratio = 0.0;
  Eigen::Index place = 0;
  for (const auto& estimate : estimates) {
    const Eigen::MatrixXd inverse = estimate->basis * estimate->basis.transpose();
    const Eigen::MatrixXd textbook = estimate->residual_variance * inverse;
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
TEST(SliceBootstrap, CountsDrawsThatCannotBeSolved) {
  auto commands = testing::RandomCommands(1000, {PropellerRegion::kFF}, 7);
  for (std::size_t k = 500; k < 550; ++k) commands[k].starboard = (k % 3 == 0) ? -0.3 : -0.9;
  const auto problem =
      BuildRegression(testing::DriveDiscrete(YellowfishTwin(), commands, kSegmentRows), {});
  const auto estimates = EstimateAll(problem);
  const auto replicates = Bootstrap(FitsOf(problem, estimates), {1000, 1, 1});
  // P(one of 20 slices is never drawn) = 0.95^20 = 0.358; four sigmas of 1000 draws are 0.061.
  EXPECT_NEAR(static_cast<double>(replicates.failures) / 1000.0, 0.358, 0.061);
  EXPECT_EQ(static_cast<std::size_t>(replicates.theta.cols()) + replicates.failures, 1000u);
}

}  // namespace
}  // namespace telltale
