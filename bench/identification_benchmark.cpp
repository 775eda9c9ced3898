// One identification, piece by piece, at the paper's size: 16,000 rows of 13 regressors, one
// thread; the physical form as a whole, on two.

#include <benchmark/benchmark.h>

#include "telltale/core/data/recording_parts.hpp"
#include "telltale/core/estimation/regression/one_step.hpp"
#include "telltale/core/identification/identify.hpp"
#include "telltale/core/paper/sample_mission.hpp"
#include "telltale/core/paper/yellowfish.hpp"
#include "telltale/core/simulation/manoeuvres.hpp"
#include "telltale/core/simulation/sensors.hpp"
#include "telltale/core/uncertainty/bootstrap.hpp"
#include "telltale/core/validation/structure_choice.hpp"

namespace telltale {
namespace {

constexpr double kDurationS = 3200.0;  // 16,000 rows at 5 Hz

Recording RecordYellowfish() {
  std::vector<TimedCommand> commands;
  for (std::uint64_t part = 0; commands.empty() || commands.back().time_s < kDurationS; ++part) {
    const double start_s = commands.empty() ? 0.0 : commands.back().time_s + 1.0;
    for (TimedCommand command : SampleMission(part + 1)) {
      command.time_s += start_s;
      commands.push_back(command);
    }
  }
  return Measure(Simulate(YellowfishTwin(), {}, commands, kDurationS, 0.02), YellowfishVehicle(),
                 {});
}

const Recording& SyntheticRecording() {
  static const Recording recording = RecordYellowfish();
  return recording;
}

const PreparedDataset& SimulatedYellowfishDataset() {
  static const PreparedDataset dataset =
      Prepare(SyntheticRecording(), YellowfishVehicle(), PrepareOptions::Robust()).value();
  return dataset;
}

/// Yaw alone, 13 regressors; the rows the regions leave out are what keeps it just under 16,000.
EquationProblem YawProblem() {
  return BuildRegression(SimulatedYellowfishDataset(), {}).equations[2];
}

void PrepareRecording(benchmark::State& state) {
  const Vehicle vehicle = YellowfishVehicle();
  for (auto _ : state) {
    benchmark::DoNotOptimize(Prepare(SyntheticRecording(), vehicle, PrepareOptions::Robust()));
  }
  state.counters["rows"] = static_cast<double>(SimulatedYellowfishDataset().rows.size());
}
BENCHMARK(PrepareRecording)->Unit(benchmark::kMillisecond);

void EstimateWithCovariance(benchmark::State& state) {
  const EquationProblem yaw = YawProblem();
  for (auto _ : state) {
    const EquationEstimate estimate = EstimateOneStep(*Assess(yaw, {}));
    benchmark::DoNotOptimize(
        Eigen::MatrixXd(estimate.residual_variance * estimate.basis * estimate.basis.transpose()));
  }
  state.counters["rows"] = static_cast<double>(yaw.y.size());
  state.counters["columns"] = static_cast<double>(yaw.phi.cols());
}
BENCHMARK(EstimateWithCovariance)->Unit(benchmark::kMillisecond);

/// 1000 replicates of the twin's yaw equation, blocks as long as its data ask for.
void BootstrapYaw(benchmark::State& state, Resampling resampling, IntervalMethod interval) {
  const EquationProblem yaw = YawProblem();
  const std::vector<ClusteredFit> fits = {FitOf(yaw, EstimateOneStep(*Assess(yaw, {})))};
  BootstrapReplicates replicates;
  for (auto _ : state) {
    replicates = Bootstrap(fits, {1000, 1, 1, resampling, interval});
    benchmark::DoNotOptimize(replicates.theta.data());
  }
  state.counters["rows"] = static_cast<double>(yaw.y.size());
  state.counters["draws"] = static_cast<double>(replicates.draws);
  state.counters["block"] = static_cast<double>(replicates.block_length);
}
BENCHMARK_CAPTURE(BootstrapYaw, slices, Resampling::kSlices, IntervalMethod::kPercentile)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(BootstrapYaw, slices_studentized, Resampling::kSlices,
                  IntervalMethod::kStudentized)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(BootstrapYaw, slices_bca, Resampling::kSlices, IntervalMethod::kBca)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(BootstrapYaw, blocks, Resampling::kMovingBlocks, IntervalMethod::kPercentile)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(BootstrapYaw, blocks_studentized, Resampling::kMovingBlocks,
                  IntervalMethod::kStudentized)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(BootstrapYaw, blocks_bca, Resampling::kMovingBlocks, IntervalMethod::kBca)
    ->Unit(benchmark::kMillisecond);

void PrepareAndIdentify(benchmark::State& state) {
  const Vehicle vehicle = YellowfishVehicle();
  IdentifyOptions options = IdentifyOptions::OneStep();
  options.bootstrap_replicates = static_cast<std::size_t>(state.range(0));
  for (auto _ : state) {
    benchmark::DoNotOptimize(Identify(SyntheticRecording(), vehicle, options));
  }
}
BENCHMARK(PrepareAndIdentify)
    ->ArgName("replicates")
    ->Arg(0)
    ->Arg(1000)
    ->Unit(benchmark::kMillisecond);

/// Wall clock of two threads. Of the longer recording there is no score.
void IdentifyPhysicalForm(benchmark::State& state) {
  const Vehicle vehicle = YellowfishVehicle();
  const Recording recording =
      Between(SyntheticRecording(), 0.0, static_cast<double>(state.range(0)));
  IdentifyOptions options;
  options.regression.structure = Structure::kFossen;
  options.threads = 2;
  for (auto _ : state) {
    benchmark::DoNotOptimize(IdentifyInGivenStructure(recording, vehicle, options));
  }
}
BENCHMARK(IdentifyPhysicalForm)
    ->ArgName("seconds")
    ->Arg(600)
    ->Arg(3200)
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace telltale
