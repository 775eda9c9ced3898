#include "telltale/core/data/segments.hpp"

#include <algorithm>
#include <cmath>

#include "telltale/core/base/contract.hpp"
#include "telltale/core/data/time_series.hpp"
#include "telltale/core/vessel/thruster_response.hpp"

namespace telltale {
namespace {

constexpr double kFilterReachS = 5.0;

struct Run {
  double start_s = 0.0;
  double end_s = 0.0;
  RowRange samples;
};

template <class Sample>
std::vector<Run> FindRuns(const std::vector<Sample>& samples, double longest_gap_s) {
  std::vector<Run> runs;
  std::size_t begin = 0;
  for (std::size_t i = 1; i <= samples.size(); ++i) {
    const bool unbroken = i < samples.size() && samples[i].time_s - samples[i - 1].time_s <=
                                                    longest_gap_s + kSameInstantS;
    if (unbroken) continue;
    runs.push_back({samples[begin].time_s, samples[i - 1].time_s, {begin, i}});
    begin = i;
  }
  return runs;
}

/// The samples among `range` that lie in [from_s, to_s].
template <class Sample>
RowRange Within(const std::vector<Sample>& samples, const RowRange& range, double from_s,
                double to_s) {
  const auto begin = samples.begin() + static_cast<std::ptrdiff_t>(range.begin);
  const auto end = samples.begin() + static_cast<std::ptrdiff_t>(range.end);
  const auto first = std::partition_point(
      begin, end, [&](const Sample& sample) { return sample.time_s < from_s; });
  const auto last =
      std::partition_point(first, end, [&](const Sample& sample) { return sample.time_s <= to_s; });
  return {static_cast<std::size_t>(first - samples.begin()),
          static_cast<std::size_t>(last - samples.begin())};
}

}  // namespace

std::vector<Segment> FindSegments(const Recording& recording, double longest_gap_s) {
  if (recording.gnss.empty() || recording.heading.empty() || recording.thrusters.empty()) return {};
  const std::array<std::vector<Run>, kChannels.size()> runs = {
      FindRuns(recording.gnss, longest_gap_s), FindRuns(recording.heading, longest_gap_s),
      FindRuns(recording.thrusters, longest_gap_s)};

  std::vector<Segment> segments;
  std::array<std::size_t, kChannels.size()> at{};
  while (at[0] < runs[0].size() && at[1] < runs[1].size() && at[2] < runs[2].size()) {
    const Run& gnss = runs[0][at[0]];
    const Run& heading = runs[1][at[1]];
    const Run& thrusters = runs[2][at[2]];
    const double start = std::max({gnss.start_s, heading.start_s, thrusters.start_s});
    const std::array ends = {gnss.end_s, heading.end_s, thrusters.end_s};
    const auto first_to_end = std::min_element(ends.begin(), ends.end());
    if (start < *first_to_end) {
      segments.push_back(
          {start, *first_to_end, {gnss.samples, heading.samples, thrusters.samples}});
    }
    ++at[static_cast<std::size_t>(first_to_end - ends.begin())];
  }
  return segments;
}

std::vector<Segment> CutSegment(const Segment& segment, const Recording& recording,
                                double longest_s) {
  Require(longest_s > 0.0, "parts of some length");
  const double duration_s = segment.end_s - segment.start_s;
  const double parts = std::max(1.0, std::ceil(duration_s / longest_s));
  std::vector<Segment> cut;
  for (double i = 0.0; i < parts; ++i) {
    const double start_s = segment.start_s + i * duration_s / parts;
    const double end_s = i + 1.0 < parts ? start_s + duration_s / parts : segment.end_s;
    const auto within = [&](const auto& samples, Channel channel, double before_s) {
      return Within(samples, segment.Of(channel), start_s - before_s, end_s + kFilterReachS);
    };
    cut.push_back({start_s,
                   end_s,
                   {within(recording.gnss, Channel::kGnss, kFilterReachS),
                    within(recording.heading, Channel::kHeading, kFilterReachS),
                    within(recording.thrusters, Channel::kThrusters, kThrusterMemoryS)}});
  }
  return cut;
}

}  // namespace telltale
