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

/// Goes through a channel in its order and says where each sample goes.
template <class Sample>
class Cursor {
 public:
  explicit Cursor(const std::vector<Sample>& samples) : samples_(samples) { PlaceNext(); }

  bool AtEnd() const { return next_ == samples_.size(); }
  const Place& NextPlace() const { return place_; }

  RawSample Take() {
    const Sample& taken = samples_[next_++];
    PlaceNext();
    return taken;
  }

 private:
  static constexpr std::size_t kAround = 2 * kNeighbours + 1;

  void PlaceNext() {
    if (AtEnd()) return;
    const double time_s = PlacedTime();
    const bool set_back = next_ > 0 && time_s < place_.time_s - kClockStepS;
    place_ = {place_.epoch + (set_back ? 1 : 0), time_s};
  }

  /// The next sample's own time, unless it disturbs the order around it and lies far from its
  /// neighbours.
  double PlacedTime() {
    const std::size_t begin = next_ < kNeighbours ? 0 : next_ - kNeighbours;
    const std::size_t end = std::min(next_ + kNeighbours + 1, samples_.size());
    for (; seen_ < end; ++seen_) See(samples_[seen_].time_s);
    std::array<double, kAround> around{};
    for (std::size_t i = begin; i < end; ++i) around[i - begin] = times_s_[i % kAround];
    const double own_s = around[next_ - begin];
    const std::span sorted(around.data(), end - begin);
    if (std::is_sorted(sorted.begin(), sorted.end())) return own_s;
    std::sort(sorted.begin(), sorted.end());
    const double median_s = sorted[sorted.size() / 2];
    return std::abs(own_s - median_s) <= kClockStepS ? own_s : median_s;
  }

  /// A time that is no number counts as the one before it.
  void See(double time_s) {
    if (std::isfinite(time_s)) latest_s_ = time_s;
    times_s_[seen_ % kAround] = latest_s_;
  }

  const std::vector<Sample>& samples_;
  std::size_t next_ = 0;
  std::size_t seen_ = 0;
  double latest_s_ = 0.0;
  std::array<double, kAround> times_s_{};  ///< of the sample `i` at i modulo kAround
  Place place_;                            ///< of the next sample
};

}  // namespace

double TimeOf(const RawSample& sample) {
  return std::visit([](const auto& s) { return s.time_s; }, sample);
}

void ForEachInOrderOfTime(const RawChannels& channels,
                          const std::function<void(const RawSample&)>& visit) {
  Cursor fixes(channels.gnss);
  Cursor headings(channels.heading);
  Cursor commands(channels.thrusters);
  const auto goes_before = [](const auto& one, const auto& other) {
    return !one.AtEnd() && (other.AtEnd() || one.NextPlace() <= other.NextPlace());
  };
  while (!fixes.AtEnd() || !headings.AtEnd() || !commands.AtEnd()) {
    if (goes_before(fixes, headings) && goes_before(fixes, commands)) {
      visit(fixes.Take());
    } else if (goes_before(headings, commands)) {
      visit(headings.Take());
    } else {
      visit(commands.Take());
    }
  }
}

std::vector<RawSample> InOrderOfTime(const RawChannels& channels) {
  std::vector<RawSample> ordered;
  ordered.reserve(channels.Size());
  ForEachInOrderOfTime(channels, [&](const RawSample& sample) { ordered.push_back(sample); });
  return ordered;
}

}  // namespace telltale
