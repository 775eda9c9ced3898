// What one telemetry sample costs the daemon once DDS has handed it over: decode, admit, keep.

#include <vector>

#include <benchmark/benchmark.h>

#include "telltale/core/data/window.hpp"
#include "telltale/core/paper/sample_mission.hpp"
#include "telltale/core/paper/yellowfish.hpp"
#include "telltale/core/simulation/manoeuvres.hpp"
#include "telltale/core/simulation/sensors.hpp"
#include "telltale/idl/codec/wire/telemetry.hpp"

namespace telltale {
namespace {

/// Ten minutes of the twin as wire samples, channel after channel in order of time.
struct WireLog {
  std::vector<telltale_wire_GnssFix> gnss;
  std::vector<telltale_wire_Heading> heading;
  std::vector<telltale_wire_Thrusters> thrusters;

  std::size_t Size() const { return gnss.size() + heading.size() + thrusters.size(); }
};

template <class Sample, class Wire>
void EncodeAll(const std::vector<Sample>& samples, std::vector<Wire>& wires) {
  std::uint64_t sequence = 0;
  for (const Sample& sample : samples) {
    wires.push_back(Encode(Telemetry<Sample>{"yellowfish", sequence++, sample}));
  }
}

const WireLog& SimulatedLog() {
  static const WireLog log = [] {
    const auto track = Simulate(YellowfishTwin(), {}, SampleMission(1), 600.0, 0.02);
    const Recording recording = Measure(track, YellowfishVehicle(), {});
    WireLog wires;
    EncodeAll(recording.gnss, wires.gnss);
    EncodeAll(recording.heading, wires.heading);
    EncodeAll(recording.thrusters, wires.thrusters);
    return wires;
  }();
  return log;
}

template <class Wire>
void Admit(const Wire& wire, Window& window) {
  const auto decoded = Decode(wire);
  if (decoded) benchmark::DoNotOptimize(window.Add(decoded->sample));
}

/// Samples come interleaved by time as a boat sends them: for each fix two pulses and ten headings.
void DecodeAndAdmit(benchmark::State& state) {
  const WireLog& log = SimulatedLog();
  for (auto _ : state) {
    Window window{WindowLimits{}};
    for (std::size_t k = 0; k < log.gnss.size(); ++k) {
      Admit(log.gnss[k], window);
      for (std::size_t i = 2 * k; i < 2 * k + 2 && i < log.thrusters.size(); ++i) {
        Admit(log.thrusters[i], window);
      }
      for (std::size_t i = 10 * k; i < 10 * k + 10 && i < log.heading.size(); ++i) {
        Admit(log.heading[i], window);
      }
    }
    benchmark::DoNotOptimize(window.Empty());
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(log.Size()));
}
BENCHMARK(DecodeAndAdmit)->Unit(benchmark::kMillisecond);

void Snapshot(benchmark::State& state) {
  const WireLog& log = SimulatedLog();
  Window window{WindowLimits{}};
  for (const auto& wire : log.heading) Admit(wire, window);
  for (auto _ : state) benchmark::DoNotOptimize(window.Snapshot());
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(log.heading.size()));
}
BENCHMARK(Snapshot)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace telltale
