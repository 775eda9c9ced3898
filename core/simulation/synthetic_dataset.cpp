#include "telltale/core/simulation/synthetic_dataset.hpp"

#include "telltale/core/data/preparation.hpp"
#include "telltale/core/simulation/synthetic_sensors.hpp"
#include "telltale/core/simulation/synthetic_track.hpp"

namespace telltale {
namespace {

// Between segments: longer than any gap that preparation bridges, and than commands matter.
constexpr double kBetweenSegmentsS = 100.0;

Vehicle VehicleOf(const PreparedDataset& dataset) {
  Vehicle vehicle;
  vehicle.gnss_antenna = dataset.sensors.antenna;
  vehicle.hull = dataset.hull;
  vehicle.mass_kg = dataset.hull.mass_kg;
  return vehicle;
}

}  // namespace

Result<SyntheticRecording> SimulateRecording(const PreparedDataset& dataset,
                                             const VesselModel& model,
                                             const SyntheticDatasetOptions& options) {
  SegmentSimulator simulator(dataset, model, options);
  SyntheticSensors sensors(dataset, options);
  SyntheticRecording synthetic{{}, VehicleOf(dataset)};
  double start_s = 0.0;
  for (std::size_t s = 0; s < dataset.segments.size(); ++s) {
    SimulatedSegment segment{dataset, s, start_s, 0.0};
    segment.shift_s = start_s - segment.First().time_s;
    const std::size_t of = dataset.RecordingOf(s);
    if (s == 0 || of != dataset.RecordingOf(s - 1)) synthetic.recording.starts_s.push_back(start_s);
    const auto track = simulator.Simulate(segment, options.constant_disturbances.empty()
                                                       ? ConstantDisturbance()
                                                       : options.constant_disturbances[of]);
    if (!track) return tl::unexpected(track.error());
    sensors.Record(segment, *track, synthetic.recording);
    start_s += segment.Duration() + kBetweenSegmentsS;
  }
  return synthetic;
}

Result<PreparedDataset> SimulateDataset(const PreparedDataset& dataset, const VesselModel& model,
                                        const SyntheticDatasetOptions& options) {
  const auto synthetic = SimulateRecording(dataset, model, options);
  if (!synthetic) return tl::unexpected(synthetic.error());
  PrepareOptions prepare = dataset.options;
  prepare.sampling_period_s = dataset.sampling_period_s;
  prepare.longest_segment_s.reset();
  return Prepare(synthetic->recording, synthetic->vehicle, prepare, options.readings);
}

}  // namespace telltale
