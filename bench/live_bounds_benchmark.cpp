// What one more row costs a live regression: 13 regressors, 20 minutes at 5 Hz held.

#include <benchmark/benchmark.h>
#include <boost/random/normal_distribution.hpp>

#include "telltale/core/base/random.hpp"
#include "telltale/core/estimation/regression/sliding_regression.hpp"

namespace telltale {
namespace {

constexpr Eigen::Index kRegressors = 13;

void SlideByOneRow(benchmark::State& state) {
  RandomEngine engine(1);
  boost::random::normal_distribution<double> normal(0.0, 1.0);
  Eigen::MatrixXd rows(kRegressors + 1, 4096);
  for (double& value : rows.reshaped()) value = normal(engine);
  SlidingRegression sliding(kRegressors, {6000, static_cast<std::size_t>(state.range(0))});
  Eigen::Index next = 0;
  for (auto _ : state) {
    const auto row = rows.col(next++ % rows.cols());
    sliding.Push({row.data(), kRegressors}, row[kRegressors], true);
  }
}
BENCHMARK(SlideByOneRow)->ArgName("lags")->Arg(0)->Arg(2)->Arg(12);

void EstimateFromGrams(benchmark::State& state) {
  RandomEngine engine(1);
  boost::random::normal_distribution<double> normal(0.0, 1.0);
  SlidingRegression sliding(kRegressors, {});
  Eigen::VectorXd row(kRegressors + 1);
  for (int k = 0; k < 6000; ++k) {
    for (double& value : row) value = normal(engine);
    sliding.Push({row.data(), kRegressors}, row[kRegressors], true);
  }
  for (auto _ : state) benchmark::DoNotOptimize(sliding.Estimate());
}
BENCHMARK(EstimateFromGrams)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace telltale
