#pragma once

#include <array>
#include <vector>

#include "telltale/core/data/prepared_dataset.hpp"
#include "telltale/core/data/samples.hpp"

namespace telltale {

/// A span of time in which no channel is silent for long.
struct Segment {
  double start_s = 0.0;
  double end_s = 0.0;
  /// The samples of each channel's own unbroken run around the segment, in the order of kChannels.
  /// Interpolation among them crosses no gap.
  std::array<RowRange, kChannels.size()> samples;

  const RowRange& Of(Channel channel) const { return samples[static_cast<std::size_t>(channel)]; }
};

/// Cuts a recording where a channel is silent for more than `longest_gap_s`, and where not all
/// three are present. Cost: linear in the samples.
std::vector<Segment> FindSegments(const Recording& recording, double longest_gap_s);

/// Equal parts of a segment, none longer than `longest_s`. Their samples extend across the cuts:
/// positions and headings by five seconds, enough for any filter, commands by kThrusterMemoryS.
std::vector<Segment> CutSegment(const Segment& segment, const Recording& recording,
                                double longest_s);

}  // namespace telltale
