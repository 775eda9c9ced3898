// Output error and the weak form with instruments at full size: 16,000 rows, 13 or all 35
// coefficients, one thread unless said.

#include <benchmark/benchmark.h>

#include "coverage/independent_simulator.hpp"
#include "telltale/core/data/preparation.hpp"
#include "telltale/core/estimation/output_error/output_error.hpp"
#include "telltale/core/estimation/output_error/output_error_covariance.hpp"
#include "telltale/core/estimation/weak_form/weak_iv.hpp"
#include "telltale/core/identification/identify.hpp"
#include "telltale/core/identification/weak_iv_estimate.hpp"
#include "telltale/core/uncertainty/bootstrap_correction.hpp"

namespace telltale {
namespace {

constexpr int kSegmentCount = 80;  // of 40 s at 5 Hz

using Columns = std::array<std::vector<std::size_t>, 3>;

/// Thirteen coefficients that make a boat by themselves: the strongest of each equation.
Columns Thirteen() {
  return {{{0, 1, 5, 7}, {0, 5, 6, 9}, {3, 4, 7, 10, 12}}};
}

Columns All() {
  return AllColumns(Parameterization::kPropeller);
}

template <std::size_t N>
std::array<double, N> KeepColumns(const std::array<double, N>& all,
                                  const std::vector<std::size_t>& columns) {
  std::array<double, N> kept{};
  for (const std::size_t column : columns) kept[column] = all[column];
  return kept;
}

/// The boat of bench/coverage with these coefficients and no others.
coverage::Boat BoatOf(const Columns& columns) {
  coverage::Boat boat = coverage::ReferenceBoat();
  boat.surge = KeepColumns(boat.surge, columns[0]);
  boat.sway = KeepColumns(boat.sway, columns[1]);
  boat.yaw = KeepColumns(boat.yaw, columns[2]);
  return boat;
}

Recording Recorded(const coverage::Boat& boat, double disturbed) {
  coverage::SimulatedEnvironment environment;
  for (double& sigma : environment.disturbance_sigma) sigma *= disturbed;
  coverage::Mission mission;
  mission.segments = kSegmentCount;
  return coverage::Simulate(boat, environment, mission, 1);
}

PreparedDataset Prepared(const coverage::Boat& boat, double disturbed) {
  return PrepareForWeakIv(Recorded(boat, disturbed), coverage::VehicleOf(), {}).value();
}

void EstimateBySimulation(benchmark::State& state, const Columns& columns, double time_constant_s,
                          double disturbed) {
  coverage::Boat boat = BoatOf(columns);
  boat.thruster_time_constant_s = time_constant_s;
  const PreparedDataset dataset = Prepared(boat, disturbed);
  RegressionOptions regression;
  if (time_constant_s > 0.0) regression.structure = Structure::kFirstOrderDynamic;
  const VesselModel start = StartOf(dataset, regression, columns);
  Eigen::Index unknowns = 0;
  std::size_t residuals = 0;
  for (auto _ : state) {
    const auto fit = EstimateOutputError(dataset, regression, columns, start, {});
    if (!fit) {
      state.SkipWithError("no answer");
      break;
    }
    benchmark::DoNotOptimize(ClusterCovariance(*fit));
    unknowns = fit->theta.size();
    residuals = fit->residuals;
  }
  state.counters["rows"] = static_cast<double>(dataset.rows.size());
  state.counters["unknowns"] = static_cast<double>(unknowns);
  state.counters["residuals"] = static_cast<double>(residuals);
}

void OutputError(benchmark::State& state, const Columns& columns) {
  EstimateBySimulation(state, columns, 0.0, 0.0);
}
BENCHMARK_CAPTURE(OutputError, thirteen, Thirteen())->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(OutputError, all, All())->Unit(benchmark::kMillisecond);

void OutputErrorLagging(benchmark::State& state) {
  EstimateBySimulation(state, All(), 0.4, 0.0);
}
BENCHMARK(OutputErrorLagging)->Unit(benchmark::kMillisecond);

void OutputErrorDisturbed(benchmark::State& state) {
  EstimateBySimulation(state, All(), 0.0, 1.0);
}
BENCHMARK(OutputErrorDisturbed)->Unit(benchmark::kMillisecond);

void WeakIv(benchmark::State& state, const Columns& columns) {
  const PreparedDataset dataset = Prepared(BoatOf(columns), 1.0);
  for (auto _ : state) {
    const auto fit = EstimateWeakIv(dataset, {}, columns, {});
    benchmark::DoNotOptimize(ClusterCovariance(*fit));
  }
  state.counters["rows"] = static_cast<double>(dataset.rows.size());
}
BENCHMARK_CAPTURE(WeakIv, thirteen, Thirteen())->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(WeakIv, all, All())->Unit(benchmark::kMillisecond);

/// The estimate and 40 parametric bootstrap replicates on two threads.
void WeakIvWithReplicates(benchmark::State& state, const Columns& columns) {
  const PreparedDataset dataset = Prepared(BoatOf(columns), 1.0);
  for (auto _ : state) {
    const auto fit = EstimateWeakIv(dataset, {}, columns, {});
    benchmark::DoNotOptimize(
        CorrectByParametricBootstrap(dataset, {}, *fit, columns, {}, {40, 1, 2}));
  }
  state.counters["rows"] = static_cast<double>(dataset.rows.size());
}
BENCHMARK_CAPTURE(WeakIvWithReplicates, thirteen, Thirteen())
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK_CAPTURE(WeakIvWithReplicates, all, All())->Unit(benchmark::kMillisecond)->UseRealTime();

/// From raw samples to a bounded model, the estimator chosen by the data, on two threads.
void IdentifyWithEstimatorSelection(benchmark::State& state, double disturbed) {
  const Recording recording = Recorded(coverage::ReferenceBoat(), disturbed);
  IdentifyOptions options;
  options.threads = 2;
  for (auto _ : state) {
    benchmark::DoNotOptimize(Identify(recording, coverage::VehicleOf(), options));
  }
}
BENCHMARK_CAPTURE(IdentifyWithEstimatorSelection, still, 0.0)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK_CAPTURE(IdentifyWithEstimatorSelection, disturbed, 1.0)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

/// One-step least squares of all three equations with covariance, from rows. Advice on
/// manoeuvres costs extra, as it simulates a catalogue of them.
void IdentifyOneStep(benchmark::State& state, bool advise) {
  const PreparedDataset dataset = Prepared(coverage::ReferenceBoat(), 1.0);
  IdentifyOptions options = IdentifyOptions::OneStep();
  options.bootstrap_replicates = 0;
  options.advise = advise;
  for (auto _ : state) {
    benchmark::DoNotOptimize(Identify(dataset, "boat", options));
  }
  state.counters["rows"] = static_cast<double>(dataset.rows.size());
}
BENCHMARK_CAPTURE(IdentifyOneStep, with_covariance, false)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(IdentifyOneStep, with_advice, true)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace telltale
