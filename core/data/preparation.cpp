#include "telltale/core/data/preparation.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <utility>

#include "telltale/core/base/contract.hpp"
#include "telltale/core/data/north_east_frame.hpp"
#include "telltale/core/data/paper_preset.hpp"
#include "telltale/core/data/repeated_readings.hpp"
#include "telltale/core/data/robust_preset.hpp"
#include "telltale/core/data/sampling_grid.hpp"
#include "telltale/core/data/savitzky_golay.hpp"
#include "telltale/core/data/segment_signals.hpp"
#include "telltale/core/data/segments.hpp"
#include "telltale/core/data/sensor_noise.hpp"
#include "telltale/core/data/slices.hpp"

namespace telltale {
namespace {

template <class Sample>
void RequireAscending(const std::vector<Sample>& samples) {
  const auto not_ascending = [](const Sample& a, const Sample& b) { return a.time_s >= b.time_s; };
  Require(std::adjacent_find(samples.begin(), samples.end(), not_ascending) == samples.end(),
          "a recording in order of time without duplicates");
}

std::vector<Segment> SegmentsOf(const Recording& recording, const PrepareOptions& options) {
  std::vector<Segment> segments = FindSegments(recording, options.longest_gap_s);
  if (!options.longest_segment_s) return segments;
  std::vector<Segment> parts;
  for (const Segment& segment : segments) {
    const auto cut = CutSegment(segment, recording, *options.longest_segment_s);
    parts.insert(parts.end(), cut.begin(), cut.end());
  }
  return parts;
}

std::optional<Refusal> MissingChannel(const Recording& recording) {
  const auto missing = [](Channel channel) {
    const std::string name(Name(channel));
    return Refusal{"data preparation", "the recording holds no " + name + " samples",
                   "check that the boat sends " + name + " and that its samples are not rejected"};
  };
  if (recording.gnss.empty()) return missing(Channel::kGnss);
  if (recording.heading.empty()) return missing(Channel::kHeading);
  if (recording.thrusters.empty()) return missing(Channel::kThrusters);
  return std::nullopt;
}

Refusal NoSegment(const PrepareOptions& options, double period_s, double longest_found_s) {
  const double window_s = 2.0 * static_cast<double>(options.smoothing_half_width) * period_s;
  std::ostringstream reason;
  reason << "the longest segment in which no channel is silent for more than "
         << options.longest_gap_s << " s lasts " << longest_found_s << " s, and "
         << std::max(options.shortest_segment_s, window_s) << " s are needed";
  return {"data preparation", reason.str(),
          "record longer without interruptions, or allow a longer longest_gap_s"};
}

/// A segment that is long enough, and its grid.
struct LaidSegment {
  Segment segment;
  SamplingGrid grid;
};

/// At least one. Refuses when: Prepare() does.
Result<std::vector<LaidSegment>> LaySegments(const Recording& recording,
                                             const PrepareOptions& options) {
  if (auto refusal = options.Validate()) return tl::unexpected(*std::move(refusal));
  if (auto refusal = MissingChannel(recording)) return tl::unexpected(*std::move(refusal));
  RequireAscending(recording.gnss);
  RequireAscending(recording.heading);
  RequireAscending(recording.thrusters);
  const double period_s = SamplingPeriod(recording.gnss, options);
  double longest_found_s = 0.0;
  std::vector<LaidSegment> laid;
  for (const Segment& segment : SegmentsOf(recording, options)) {
    longest_found_s = std::max(longest_found_s, segment.end_s - segment.start_s);
    const SamplingGrid grid = LayGrid(recording, segment, period_s);
    if (LongEnough(grid, options)) laid.push_back({segment, grid});
  }
  if (laid.empty()) return tl::unexpected(NoSegment(options, period_s, longest_found_s));
  return laid;
}

std::size_t RowsOf(const std::vector<LaidSegment>& laid) {
  std::size_t rows = 0;
  for (const LaidSegment& segment : laid) rows += segment.grid.rows;
  return rows;
}

void Append(PreparedDataset& dataset, const std::vector<PreparedRow>& rows,
            const PrepareOptions& options) {
  const RowRange segment{dataset.rows.size(), dataset.rows.size() + rows.size()};
  dataset.rows.insert(dataset.rows.end(), rows.begin(), rows.end());
  dataset.segments.push_back(segment);
  const auto longest = static_cast<std::size_t>(
      std::max(1.0, std::floor(options.longest_slice_s / dataset.sampling_period_s + 1e-9)));
  const auto slices = CutSlices(dataset.rows, segment, longest);
  dataset.slices.insert(dataset.slices.end(), slices.begin(), slices.end());
}

/// The number of recordings that start at `time_s` or before.
std::size_t PlaceAmong(const std::vector<double>& starts_s, double time_s) {
  constexpr double kRounding = 1e-6;
  const auto after = std::upper_bound(starts_s.begin(), starts_s.end(), time_s + kRounding);
  return static_cast<std::size_t>(after - starts_s.begin());
}

// Numbers the recordings from 0, without those that have no segment.
std::vector<std::size_t> NumberedWithoutGaps(const std::vector<std::size_t>& places) {
  std::vector<std::size_t> counted(places.size(), 0);
  for (std::size_t i = 1; i < places.size(); ++i) {
    counted[i] = counted[i - 1] + (places[i] != places[i - 1] ? 1 : 0);
  }
  return counted;
}

}  // namespace

std::vector<PreparedRow> PrepareRows(const SegmentSignals& signals, const SamplingGrid& grid,
                                     const LeverArm& antenna, const PrepareOptions& options) {
  const SavitzkyGolay filter(options.smoothing_half_width, options.smoothing_degree);
  return options.preset == Preset::kPaper ? PrepareAsPaper(signals, grid, antenna, filter)
                                          : PrepareRobustly(signals, grid, antenna, filter);
}

std::optional<Refusal> WhyNotPrepared(const Recording& recording, const PrepareOptions& options) {
  const auto without_repeats = WithoutRepeatedReadings(recording);
  const auto laid = LaySegments(without_repeats ? *without_repeats : recording, options);
  return laid ? std::nullopt : std::optional(laid.error());
}

Result<PreparedDataset> Prepare(const Recording& recording, const Vehicle& vehicle,
                                const PrepareOptions& options, Readings readings) {
  const auto without_repeats = WithoutRepeatedReadings(recording);
  const Recording& measured = without_repeats ? *without_repeats : recording;
  const auto laid = LaySegments(measured, options);
  if (!laid) return tl::unexpected(laid.error());
  PreparedDataset dataset;
  dataset.sampling_period_s = laid->front().grid.period_s;
  dataset.origin = {measured.gnss.front().latitude_deg, measured.gnss.front().longitude_deg};
  dataset.rejected = measured.rejected;
  dataset.options = options;
  dataset.sensors.antenna = vehicle.gnss_antenna;
  dataset.hull = vehicle.HullOrDefault();
  dataset.rows.reserve(RowsOf(*laid));
  const NorthEastFrame frame(dataset.origin);
  std::vector<std::size_t> places;  // of each segment among the recordings
  for (const auto& [segment, grid] : *laid) {
    SegmentSignals signals = ReadSignals(measured, segment, vehicle, frame);
    Append(dataset, PrepareRows(signals, grid, vehicle.gnss_antenna, options), options);
    places.push_back(PlaceAmong(measured.starts_s, segment.start_s));
    const SignalNoise noise(signals);
    PoolSensors(dataset, signals, noise);
    PoolNoise(dataset, NoiseInVelocity(noise, signals, grid, options));
    dataset.commands.push_back(std::move(signals.commands));
    if (readings == Readings::kKept) dataset.signals.push_back(static_cast<RawSignals&&>(signals));
  }
  dataset.recordings = NumberedWithoutGaps(places);
  return dataset;
}

}  // namespace telltale
