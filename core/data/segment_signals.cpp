#include "telltale/core/data/segment_signals.hpp"

#include <span>

#include "telltale/core/data/heading_unwrap.hpp"

namespace telltale {
namespace {

template <class Sample>
std::span<const Sample> SamplesIn(const std::vector<Sample>& samples, const RowRange& range) {
  return std::span(samples).subspan(range.begin, range.size());
}

}  // namespace

SegmentSignals ReadSignals(const Recording& recording, const Segment& segment,
                           const Vehicle& vehicle, const NorthEastFrame& frame) {
  SegmentSignals signals{
      {}, HeldCommands(SamplesIn(recording.thrusters, segment.Of(Channel::kThrusters)), vehicle)};
  const auto fixes = SamplesIn(recording.gnss, segment.Of(Channel::kGnss));
  for (auto* column : {&signals.north_m.times_s, &signals.north_m.values, &signals.east_m.values}) {
    column->reserve(fixes.size());
  }
  for (const GnssFix& fix : fixes) {
    const NorthEastPosition antenna = frame.Forward({fix.latitude_deg, fix.longitude_deg});
    signals.north_m.times_s.push_back(fix.time_s);
    signals.north_m.values.push_back(antenna.north_m);
    signals.east_m.values.push_back(antenna.east_m);
  }
  signals.east_m.times_s = signals.north_m.times_s;
  const auto headings = SamplesIn(recording.heading, segment.Of(Channel::kHeading));
  signals.psi_rad.times_s.reserve(headings.size());
  for (const HeadingSample& sample : headings) signals.psi_rad.times_s.push_back(sample.time_s);
  signals.psi_rad.values = Unwrap(headings);
  return signals;
}

}  // namespace telltale
