// Least squares with covariance and 1000 bootstrap replicates on made-up numbers of the size the
// goals name, 16,000 rows of 13 regressors, one thread. bench/compare_bootstrap.py times the same
// jobs in numpy and statsmodels.

#include <benchmark/benchmark.h>
#include <boost/random/normal_distribution.hpp>

#include "telltale/core/base/random.hpp"
#include "telltale/core/estimation/regression/one_step.hpp"
#include "telltale/core/uncertainty/block_length.hpp"
#include "telltale/core/uncertainty/bootstrap.hpp"
#include "telltale/core/uncertainty/timeline.hpp"

namespace telltale {
namespace {

constexpr Eigen::Index kRows = 16000;
constexpr Eigen::Index kColumns = 13;

/// A first-order autoregression, so that blocks have a length to find.
Eigen::VectorXd Coloured(double memory, RandomEngine& engine) {
  boost::random::normal_distribution<double> normal(0.0, 1.0);
  Eigen::VectorXd series(kRows);
  double value = 0.0;
  for (double& element : series) element = value = memory * value + normal(engine);
  return series;
}

EquationProblem MadeUpProblem(std::size_t slices) {
  RandomEngine engine(1);
  EquationProblem problem;
  problem.equation = Equation::kYaw;
  problem.regressors = Regressors(Equation::kYaw, Parameterization::kPropeller);
  problem.phi.resize(kRows, kColumns);
  for (auto column : problem.phi.colwise()) column = Coloured(0.9, engine);
  problem.y = problem.phi.rowwise().sum() + Coloured(0.5, engine);
  for (std::size_t i = 0; i < static_cast<std::size_t>(kRows); ++i) problem.instants.push_back(i);
  for (std::size_t s = 0; s < slices; ++s) {
    problem.clusters.push_back({s * kRows / slices, (s + 1) * kRows / slices});
  }
  return problem;
}

std::vector<ClusteredFit> MadeUpFit(std::size_t slices) {
  const EquationProblem problem = MadeUpProblem(slices);
  return {FitOf(problem, EstimateOneStep(*Assess(problem, {})))};
}

void LeastSquaresWithCovariance(benchmark::State& state) {
  const EquationProblem problem = MadeUpProblem(40);
  for (auto _ : state) {
    const EquationEstimate estimate = EstimateOneStep(*Assess(problem, {}));
    benchmark::DoNotOptimize(
        Eigen::MatrixXd(estimate.residual_variance * estimate.basis * estimate.basis.transpose()));
  }
}
BENCHMARK(LeastSquaresWithCovariance)->Unit(benchmark::kMillisecond);

void SliceReplicates(benchmark::State& state, IntervalMethod interval) {
  const auto fits = MadeUpFit(static_cast<std::size_t>(state.range(0)));
  for (auto _ : state) {
    benchmark::DoNotOptimize(Bootstrap(fits, {1000, 1, 1, Resampling::kSlices, interval}));
  }
}
BENCHMARK_CAPTURE(SliceReplicates, percentile, IntervalMethod::kPercentile)
    ->ArgName("slices")
    ->Arg(40)
    ->Arg(130)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(SliceReplicates, studentized, IntervalMethod::kStudentized)
    ->ArgName("slices")
    ->Arg(130)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(SliceReplicates, bca, IntervalMethod::kBca)
    ->ArgName("slices")
    ->Arg(130)
    ->Unit(benchmark::kMillisecond);

/// Length 0 is chosen from the data, that choice included in the time.
void BlockReplicates(benchmark::State& state, IntervalMethod interval) {
  const auto fits = MadeUpFit(40);
  BootstrapOptions options{1000, 1, 1, Resampling::kMovingBlocks, interval};
  options.block_length = static_cast<std::size_t>(state.range(0));
  BootstrapReplicates replicates;
  for (auto _ : state) {
    replicates = Bootstrap(fits, options);
    benchmark::DoNotOptimize(replicates.theta.data());
  }
  state.counters["block"] = static_cast<double>(replicates.block_length);
}
BENCHMARK_CAPTURE(BlockReplicates, percentile, IntervalMethod::kPercentile)
    ->ArgName("length")
    ->Arg(0)
    ->Arg(25)
    ->Arg(50)
    ->Arg(100)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(BlockReplicates, studentized, IntervalMethod::kStudentized)
    ->ArgName("length")
    ->Arg(50)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(BlockReplicates, bca, IntervalMethod::kBca)
    ->ArgName("length")
    ->Arg(50)
    ->Unit(benchmark::kMillisecond);

void ChooseBlockLength(benchmark::State& state) {
  const auto fits = MadeUpFit(40);
  for (auto _ : state) {
    const Timeline timeline = TimelineOf(fits);
    benchmark::DoNotOptimize(BlockLength(InfluenceAlong(timeline, fits[0]), timeline.runs));
  }
}
BENCHMARK(ChooseBlockLength)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace telltale
