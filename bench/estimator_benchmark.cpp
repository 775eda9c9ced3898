// Output error at the size: 16,000 rows, all 35 coefficients, one thread.

#include <benchmark/benchmark.h>

#include "coverage/truth.hpp"
#include "data/preparation.hpp"
#include "estimation/output_error.hpp"
#include "estimation/weak_iv.hpp"

namespace telltale {
namespace {

constexpr int kStretches = 80;  // of 40 s at 5 Hz

PreparedDataset Recorded(double time_constant_s, double disturbance) {
  coverage::Boat boat = coverage::ReferenceBoat();
  boat.thruster_time_constant_s = time_constant_s;
  coverage::Surroundings around;
  for (double& sigma : around.disturbance_sigma) sigma *= disturbance;
  coverage::Mission mission;
  mission.segments = kStretches;
  const Recording recording = coverage::Sail(boat, around, mission, 1);
  return Prepare(recording, coverage::VehicleOf(), {}).value();
}

void Estimate(benchmark::State& state, double time_constant_s, double disturbance) {
  const PreparedDataset dataset = Recorded(time_constant_s, disturbance);
  RegressionOptions regression;
  if (time_constant_s > 0.0) regression.structure = Structure::kFirstOrderDynamic;
  const auto columns = AllColumns(Parameterization::kPropeller);
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

void OutputError(benchmark::State& state) {
  Estimate(state, 0.0, 0.0);
}
BENCHMARK(OutputError)->Unit(benchmark::kMillisecond);

void OutputErrorLagging(benchmark::State& state) {
  Estimate(state, 0.4, 0.0);
}
BENCHMARK(OutputErrorLagging)->Unit(benchmark::kMillisecond);

void OutputErrorDisturbed(benchmark::State& state) {
  Estimate(state, 0.0, 1.0);
}
BENCHMARK(OutputErrorDisturbed)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace telltale
