// One diagnosis of 600 s with all effects against four recordings of as long, wall clock of two
// threads, and how long each stage of it takes.

#include <benchmark/benchmark.h>

#include <chrono>
#include <map>
#include <string>

#include "coverage/hull_recording.hpp"
#include "telltale/core/data/preparation.hpp"
#include "telltale/core/diagnosis/diagnose.hpp"
#include "telltale/core/identification/identify.hpp"

namespace telltale {
namespace {

using coverage::Hull;
using coverage::Sea;

constexpr double kDurationS = 600.0;

const Hull& Boat() {
  static const Hull hull = coverage::Catamaran();
  return hull;
}

Recording Recorded(const Sea& sea, double duration_s, std::uint64_t seed) {
  constexpr double kDayS = 86400.0;
  return RecordHull(Boat(), sea, {}, duration_s, static_cast<double>(seed) * kDayS, seed);
}

PreparedDataset Day(const Sea& sea, std::uint64_t seed, double sampling_period_s) {
  PrepareOptions options = PrepareOptions::Robust();
  options.sampling_period_s = sampling_period_s;
  return Prepare(Recorded(sea, kDurationS, seed), VehicleOf(Boat()), options).value();
}

Sea Rough() {
  Sea sea;
  sea.wave_sigma = 0.2;
  return sea;
}

Identification ModelOf(Structure structure) {
  IdentifyOptions options;
  options.regression.structure = structure;
  options.estimator =
      structure == Structure::kFossen ? Estimator::kPredictionError : Estimator::kWeakIv;
  options.threads = 2;
  return Identify(Recorded({}, 3.0 * kDurationS, 1), VehicleOf(Boat()), options).value();
}

/// Seconds in each stage.
class Stages {
 public:
  void Enter(std::string_view stage) {
    const auto now = Clock::now();
    if (!stage_.empty()) seconds_[stage_] += std::chrono::duration<double>(now - since_).count();
    stage_ = stage;
    since_ = now;
  }
  const std::map<std::string, double>& Seconds() const { return seconds_; }

 private:
  using Clock = std::chrono::steady_clock;
  std::map<std::string, double> seconds_;
  std::string stage_;
  Clock::time_point since_;
};

void DiagnoseDay(benchmark::State& state, Structure structure, const Sea& sea,
                 bool leave_out_references) {
  const Identification model = ModelOf(structure);
  const double period_s = model.sampling_period_s;
  std::vector<PreparedDataset> references;
  for (const std::uint64_t seed : {2, 3, 4, 5}) references.push_back(Day({}, seed, period_s));
  const PreparedDataset recording = Day(sea, 6, period_s);
  DiagnoseOptions options;
  options.leave_out_references = leave_out_references;
  options.threads = 2;
  Stages stages;
  for (auto _ : state) {
    benchmark::DoNotOptimize(
        Diagnose(recording, references, model, model.vehicle_id, options,
                 [&](std::string_view stage, double) { stages.Enter(stage); }));
  }
  for (const auto& [stage, seconds] : stages.Seconds()) {
    state.counters[stage] = benchmark::Counter(seconds, benchmark::Counter::kAvgIterations);
  }
}
BENCHMARK_CAPTURE(DiagnoseDay, calm, Structure::kStaticQuadratic, {}, false)
    ->UseRealTime()
    ->Unit(benchmark::kSecond);
BENCHMARK_CAPTURE(DiagnoseDay, waves, Structure::kStaticQuadratic, Rough(), false)
    ->UseRealTime()
    ->Unit(benchmark::kSecond);
BENCHMARK_CAPTURE(DiagnoseDay, calm_without_each_reference, Structure::kStaticQuadratic, {}, true)
    ->UseRealTime()
    ->Unit(benchmark::kSecond);
BENCHMARK_CAPTURE(DiagnoseDay, waves_without_each_reference, Structure::kStaticQuadratic, Rough(),
                  true)
    ->UseRealTime()
    ->Unit(benchmark::kSecond);
BENCHMARK_CAPTURE(DiagnoseDay, physical_form, Structure::kFossen, {}, false)
    ->UseRealTime()
    ->Unit(benchmark::kSecond);

}  // namespace
}  // namespace telltale
