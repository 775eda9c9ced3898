#include "telltale/core/data/recording_parts.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
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

double ChangeAt(const std::vector<ThrusterSample>& commands, std::size_t i) {
  return std::abs(commands[i].port_us - commands[i - 1].port_us) +
         std::abs(commands[i].starboard_us - commands[i - 1].starboard_us);
}

/// The end of the part in which the commands change the most.
double LiveliestEnd(const std::vector<ThrusterSample>& commands, double duration_s) {
  double end_s = commands.front().time_s;
  double most = 0.0;
  double changes = 0.0;
  std::size_t first = 0;
  for (std::size_t last = 1; last < commands.size(); ++last) {
    changes += ChangeAt(commands, last);
    while (commands[first].time_s < commands[last].time_s - duration_s) {
      changes -= ChangeAt(commands, ++first);
    }
    if (changes <= most) continue;
    most = changes;
    end_s = commands[last].time_s;
  }
  return end_s;
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

Recording Liveliest(const Recording& recording, double duration_s) {
  const std::vector<ThrusterSample>& commands = recording.thrusters;
  if (commands.empty() || commands.back().time_s - commands.front().time_s <= duration_s) {
    return recording;
  }
  const double end_s =
      std::max(LiveliestEnd(commands, duration_s), commands.front().time_s + duration_s);
  return Between(recording, end_s - duration_s, end_s);
}

Recording Latest(const Recording& recording, double duration_s) {
  const double since_s = EndTime(recording) - duration_s;
  return {SamplesSince(recording.gnss, since_s), SamplesSince(recording.heading, since_s),
          SamplesSince(recording.thrusters, since_s), recording.rejected};
}

}  // namespace telltale
