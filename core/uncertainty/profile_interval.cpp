#include "telltale/core/uncertainty/profile_interval.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include <boost/math/tools/toms748_solve.hpp>

#include "telltale/core/base/contract.hpp"

namespace telltale {
namespace {

/// One end: `direction` is -1 or 1.
double End(const std::function<double(double)>& deviance, const ProfileSearch& search,
           double threshold, double direction) {
  const double limit = direction < 0.0 ? search.lowest : search.highest;
  const auto beyond = [&](double value) { return deviance(value) - threshold; };
  double inside = search.estimate;
  double step = search.step;
  for (;;) {
    const double next =
        direction < 0.0 ? std::max(inside - step, limit) : std::min(inside + step, limit);
    const double there = beyond(next);
    if (there > 0.0) {
      const double here = inside == search.estimate ? -threshold : beyond(inside);
      const double close = 1e-3 * std::abs(next - search.estimate);
      std::uintmax_t most = 60;
      const auto [low, high] = boost::math::tools::toms748_solve(
          beyond, std::min(inside, next), std::max(inside, next), direction < 0.0 ? there : here,
          direction < 0.0 ? here : there,
          [&](double a, double b) { return std::abs(b - a) <= close; }, most);
      return 0.5 * (low + high);
    }
    if (next == limit) return limit;
    inside = next;
    step *= 2.0;
  }
}

}  // namespace

Interval ProfileInterval(const std::function<double(double)>& deviance, const ProfileSearch& search,
                         double threshold, double level) {
  Require(threshold > 0.0 && search.step > 0.0, "a positive threshold and step");
  Require(search.lowest <= search.estimate && search.estimate <= search.highest,
          "an estimate within the limits");
  return {level, End(deviance, search, threshold, -1.0), End(deviance, search, threshold, 1.0)};
}

double Asymmetry(const Interval& interval, double estimate) {
  const double below = estimate - interval.lower;
  const double above = interval.upper - estimate;
  const double shorter = std::min(below, above);
  return shorter > 0.0 ? std::max(below, above) / shorter : std::numeric_limits<double>::infinity();
}

}  // namespace telltale
