#include "telltale/client/recording/time_order.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>

namespace telltale {
namespace {

constexpr double kClockStepS = 60.0;
constexpr std::size_t kNeighbours = 2;  // to each side: two wrong times in a row are seen through

/// Where a sample goes: epochs one after the other, and by time inside each.
struct Place {
  std::size_t epoch = 0;
  double time_s = 0.0;
  auto operator<=>(const Place&) const = default;
};

// A sample's own time, unless it disturbs the order around it and lies far from its neighbours.
double PlacedTime(const std::vector<double>& times, std::size_t i) {
  const std::size_t begin = i < kNeighbours ? 0 : i - kNeighbours;
  const std::size_t end = std::min(i + kNeighbours + 1, times.size());
  const std::span around(times.data() + begin, end - begin);
  if (std::is_sorted(around.begin(), around.end())) return times[i];
  std::vector<double> sorted(around.begin(), around.end());
  std::sort(sorted.begin(), sorted.end());
  const double median_s = sorted[sorted.size() / 2];
  return std::abs(times[i] - median_s) <= kClockStepS ? times[i] : median_s;
}

template <class Sample>
std::vector<double> FiniteTimes(const std::vector<Sample>& samples) {
  std::vector<double> times;
  times.reserve(samples.size());
  double latest_s = 0.0;
  for (const Sample& sample : samples) {
    if (std::isfinite(sample.time_s)) latest_s = sample.time_s;
    times.push_back(latest_s);
  }
  return times;
}

template <class Sample>
std::vector<Place> PlacesOf(const std::vector<Sample>& samples) {
  const std::vector<double> times = FiniteTimes(samples);
  std::vector<Place> places;
  places.reserve(times.size());
  Place place;
  for (std::size_t i = 0; i < times.size(); ++i) {
    const double time_s = PlacedTime(times, i);
    const bool set_back = i > 0 && time_s < place.time_s - kClockStepS;
    place = {place.epoch + (set_back ? 1 : 0), time_s};
    places.push_back(place);
  }
  return places;
}

}  // namespace

double TimeOf(const RawSample& sample) {
  return std::visit([](const auto& s) { return s.time_s; }, sample);
}

std::vector<RawSample> InOrderOfTime(const std::vector<GnssFix>& gnss,
                                     const std::vector<HeadingSample>& heading,
                                     const std::vector<ThrusterSample>& thrusters) {
  const std::array places = {PlacesOf(gnss), PlacesOf(heading), PlacesOf(thrusters)};
  std::array<std::size_t, 3> next{};
  const auto sample = [&](std::size_t channel) -> RawSample {
    const std::size_t i = next[channel]++;
    if (channel == 0) return gnss[i];
    if (channel == 1) return heading[i];
    return thrusters[i];
  };
  std::vector<RawSample> ordered;
  ordered.reserve(gnss.size() + heading.size() + thrusters.size());
  while (ordered.size() < ordered.capacity()) {
    std::size_t first = places.size();
    for (std::size_t channel = 0; channel < places.size(); ++channel) {
      if (next[channel] == places[channel].size()) continue;
      if (first == places.size() || places[channel][next[channel]] < places[first][next[first]]) {
        first = channel;
      }
    }
    ordered.push_back(sample(first));
  }
  return ordered;
}

}  // namespace telltale
