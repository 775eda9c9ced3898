#include "telltale/core/data/recording_parts.hpp"

#include <algorithm>
#include <iterator>

namespace telltale {
namespace {

template <class Sample>
std::vector<Sample> SamplesBetween(const std::vector<Sample>& samples, double from_s, double to_s) {
  const auto first = std::ranges::upper_bound(samples, from_s, {}, &Sample::time_s);
  const auto last = std::ranges::upper_bound(samples, to_s, {}, &Sample::time_s);
  return {first, std::max(first, last)};
}

template <class Sample>
std::vector<Sample> SamplesSince(const std::vector<Sample>& samples, double time_s) {
  const auto first = std::ranges::lower_bound(samples, time_s, {}, &Sample::time_s);
  return {first, samples.end()};
}

}  // namespace

double EndTime(const Recording& recording) {
  double end_s = 0.0;
  if (!recording.gnss.empty()) end_s = std::max(end_s, recording.gnss.back().time_s);
  if (!recording.heading.empty()) end_s = std::max(end_s, recording.heading.back().time_s);
  if (!recording.thrusters.empty()) end_s = std::max(end_s, recording.thrusters.back().time_s);
  return end_s;
}

Recording Between(const Recording& recording, double from_s, double to_s) {
  Recording part{SamplesBetween(recording.gnss, from_s, to_s),
                 SamplesBetween(recording.heading, from_s, to_s),
                 SamplesBetween(recording.thrusters, from_s, to_s), recording.rejected};
  std::ranges::copy_if(recording.starts_s, std::back_inserter(part.starts_s),
                       [&](double start_s) { return start_s > from_s && start_s <= to_s; });
  return part;
}

Recording Latest(const Recording& recording, double duration_s) {
  const double since_s = EndTime(recording) - duration_s;
  return {SamplesSince(recording.gnss, since_s), SamplesSince(recording.heading, since_s),
          SamplesSince(recording.thrusters, since_s), recording.rejected};
}

}  // namespace telltale
