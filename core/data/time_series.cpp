#include "telltale/core/data/time_series.hpp"

#include <algorithm>
#include <array>

#include "telltale/core/base/contract.hpp"

namespace telltale {
namespace {

constexpr std::size_t kMostKnots = 16;

}  // namespace

double EvaluatePolynomialThrough(std::span<const double> times, std::span<const double> values,
                                 double t) {
  Require(!values.empty() && values.size() <= kMostKnots, "one to sixteen points");
  std::array<double, kMostKnots> p{};  // no heap: this runs for each row of each signal
  std::ranges::copy(values, p.begin());
  for (std::size_t order = 1; order < values.size(); ++order) {
    for (std::size_t i = 0; i + order < values.size(); ++i) {
      p[i] = ((times[i + order] - t) * p[i] + (t - times[i]) * p[i + 1]) /
             (times[i + order] - times[i]);
    }
  }
  return p.front();
}

std::size_t TimeSeries::CountUntil(double t) const {
  return LaterThan(t + kSameInstantS);
}

TimeSeries TimeSeries::Within(double from_s, double to_s) const {
  const auto begin = std::ranges::lower_bound(times_s, from_s) - times_s.begin();
  const auto end = std::ranges::lower_bound(times_s, to_s) - times_s.begin();
  return {{times_s.begin() + begin, times_s.begin() + end},
          {values.begin() + begin, values.begin() + end}};
}

double TimeSeries::Extrapolate(double t, std::size_t degree) const {
  const std::size_t until = CountUntil(t);
  Require(until > 0, "a sample not later than the time extrapolated to");
  const std::size_t knots = std::min(degree + 1, until);
  return EvaluatePolynomialThrough({times_s.data() + until - knots, knots},
                                   {values.data() + until - knots, knots}, t);
}

double TimeSeries::Interpolate(double t) const {
  if (t <= times_s.front()) return values.front();
  if (t >= times_s.back()) return values.back();
  const std::size_t right = LaterThan(t);
  const std::size_t left = right - 1;
  const double apart = 0.5 * (times_s[right] - times_s[left]);
  std::size_t before = left;
  while (before > 0 && times_s[left] - times_s[before] < apart) --before;
  std::size_t after = right;
  while (after + 1 < times_s.size() && times_s[after] - times_s[right] < apart) ++after;

  std::array<double, 4> knots = {times_s[left], times_s[right]};
  std::array<double, 4> at_knots = {values[left], values[right]};
  std::size_t count = 2;
  const auto add = [&](std::size_t i) {
    knots[count] = times_s[i];
    at_knots[count++] = values[i];
  };
  if (times_s[left] - times_s[before] >= apart) add(before);
  if (times_s[after] - times_s[right] >= apart) add(after);
  return EvaluatePolynomialThrough({knots.data(), count}, {at_knots.data(), count}, t);
}

std::size_t TimeSeries::LaterThan(double t) const {
  return static_cast<std::size_t>(std::upper_bound(times_s.begin(), times_s.end(), t) -
                                  times_s.begin());
}

double TimeSeries::Linear(double t) const {
  if (t <= times_s.front()) return values.front();
  if (t >= times_s.back()) return values.back();
  const std::size_t right = LaterThan(t);
  const double share = (t - times_s[right - 1]) / (times_s[right] - times_s[right - 1]);
  return values[right - 1] + share * (values[right] - values[right - 1]);
}

double TimeSeries::MeanAbout(double t, double width_s) const {
  // Cut alike on both sides near an end, so that the mean stays centred.
  const double reach = std::min({width_s / 2.0, t - times_s.front(), times_s.back() - t});
  if (reach <= kSameInstantS) return Linear(t);
  const double end = t + reach;
  double from = t - reach;
  double value = Linear(from);
  double area = 0.0;
  for (std::size_t i = LaterThan(from); from < end; ++i) {
    const double to = i < times_s.size() ? std::min(times_s[i], end) : end;
    const double next = Linear(to);
    area += 0.5 * (value + next) * (to - from);
    from = to;
    value = next;
  }
  return area / (2.0 * reach);
}

}  // namespace telltale
