#include "recording/time_order.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <tuple>

namespace telltale {
namespace {

constexpr double kEpochStepS = 60.0;
constexpr std::size_t kNeighbours = 2;  // to each side: two wrong times in a row are seen through

/// Where a sample goes: epochs one after the other, and by time inside each.
struct Place {
  std::size_t epoch = 0;
  double time_s = 0.0;
  auto operator<=>(const Place&) const = default;
};

double MedianAround(const std::vector<double>& times, std::size_t i) {
  std::array<double, 2 * kNeighbours + 1> around;
  const std::size_t begin = i < kNeighbours ? 0 : i - kNeighbours;
  const std::size_t end = std::min(i + kNeighbours + 1, times.size());
  const auto last = std::copy(times.begin() + static_cast<std::ptrdiff_t>(begin),
                              times.begin() + static_cast<std::ptrdiff_t>(end), around.begin());
  const auto middle = around.begin() + (last - around.begin()) / 2;
  std::nth_element(around.begin(), middle, last);
  return *middle;
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
    const double time_s = MedianAround(times, i);
    const bool set_back = i > 0 && time_s < place.time_s - kEpochStepS;
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
