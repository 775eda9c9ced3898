#include "telltale/client/recording/due_times.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>

namespace telltale {
namespace {

/// False where either is NaN.
bool IsNear(double a_s, double b_s) {
  return std::abs(a_s - b_s) <= kLongestSilenceS;
}

/// Whether sample `i` has the time of the clock, or of a new one that the next sample confirms.
bool IsOnAClock(const std::vector<RawSample>& samples, std::size_t i, double clock_s) {
  const double time_s = TimeOf(samples[i]);
  if (IsNear(time_s, clock_s)) return true;
  return i + 1 < samples.size() && IsNear(time_s, TimeOf(samples[i + 1]));
}

}  // namespace

std::vector<double> DueTimes(const std::vector<RawSample>& samples) {
  std::vector<double> due_s;
  due_s.reserve(samples.size());
  std::optional<double> clock_s;  // its newest time
  double now_s = 0.0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double time_s = TimeOf(samples[i]);
    if (!clock_s) {
      if (std::isfinite(time_s)) clock_s = time_s;
    } else if (IsOnAClock(samples, i, *clock_s)) {
      now_s += std::clamp(time_s - *clock_s, 0.0, kLongestSilenceS);
      clock_s = IsNear(time_s, *clock_s) ? std::max(time_s, *clock_s) : time_s;
    }
    due_s.push_back(now_s);
  }
  return due_s;
}

}  // namespace telltale
