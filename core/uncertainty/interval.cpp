#include "telltale/core/uncertainty/interval.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include "telltale/core/base/contract.hpp"
#include "telltale/core/uncertainty/distributions.hpp"

namespace telltale {
namespace {

double Quantile(const std::vector<double>& sorted, double share) {
  const double position = share * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(std::floor(position));
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  return std::lerp(sorted[below], sorted[above], position - static_cast<double>(below));
}

std::vector<double> Sorted(std::span<const double> values) {
  Require(values.size() > 1, "at least two replicates");
  std::vector<double> sorted(values.begin(), values.end());
  std::sort(sorted.begin(), sorted.end());
  return sorted;
}

double NearestQuantile(std::vector<double>& values, double share) {
  const auto place =
      static_cast<std::ptrdiff_t>(std::lround(share * static_cast<double>(values.size() - 1)));
  std::nth_element(values.begin(), values.begin() + place, values.end());
  return values[static_cast<std::size_t>(place)];
}

double Width(const Interval& interval) {
  return interval.upper - interval.lower;
}

/// The standard normal deviate of the share of replicates below the estimate, ties counted half.
/// All on one side would be infinitely far; half a replicate is left on the other.
double MedianBias(double estimate, const std::vector<double>& sorted) {
  const auto [from, to] = std::equal_range(sorted.begin(), sorted.end(), estimate);
  const double count = static_cast<double>(sorted.size());
  const double below =
      static_cast<double>(from - sorted.begin()) + 0.5 * static_cast<double>(to - from);
  const double share = std::clamp(below, 0.5, count - 0.5) / count;
  return NormalQuantile(share);
}

/// Which share of the replicates stands where a normal, unaccelerated distribution has `share`.
double CorrectedShare(double share, double bias, double acceleration) {
  const double deviate = bias + NormalQuantile(share);
  const double denominator = 1.0 - acceleration * deviate;
  if (denominator <= 0.0) return deviate > 0.0 ? 1.0 : 0.0;
  return NormalCdf(bias + deviate / denominator);
}

}  // namespace

std::string_view Name(IntervalMethod method) {
  switch (method) {
    case IntervalMethod::kPercentile: return "PERCENTILE";
    case IntervalMethod::kStudentized: return "STUDENTIZED";
    case IntervalMethod::kBca: return "BCA";
    case IntervalMethod::kUnknown: break;
  }
  return "UNKNOWN";
}

Interval StudentInterval(double estimate, double standard_error, double degrees_of_freedom,
                         double level) {
  const double half = standard_error * StudentQuantile(degrees_of_freedom, 0.5 * (1.0 + level));
  return {level, estimate - half, estimate + half};
}

Interval NormalInterval(double estimate, double standard_error, double level) {
  const double half = standard_error * NormalQuantile(0.5 * (1.0 + level));
  return {level, estimate - half, estimate + half};
}

Interval PercentileInterval(std::span<const double> replicates, double level) {
  const std::vector<double> sorted = Sorted(replicates);
  const double tail = 0.5 * (1.0 - level);
  return {level, Quantile(sorted, tail), Quantile(sorted, 1.0 - tail)};
}

Interval IntervalWithin(std::vector<double> draws, double estimate, double level, double least,
                        double greatest) {
  Require(!draws.empty(), "a draw");
  const double tail = 0.5 * (1.0 - level);
  Interval interval{level, NearestQuantile(draws, tail), NearestQuantile(draws, 1.0 - tail)};
  const Interval from_least{level, least, NearestQuantile(draws, level)};
  const Interval to_greatest{level, NearestQuantile(draws, 1.0 - level), greatest};
  for (const Interval& one_sided : {from_least, to_greatest}) {
    if (Width(one_sided) < Width(interval)) interval = one_sided;
  }
  interval.lower = std::min(interval.lower, estimate);
  interval.upper = std::max(interval.upper, estimate);
  return interval;
}

Interval StudentizedInterval(double estimate, double standard_error,
                             std::span<const double> replicates,
                             std::span<const double> standard_errors, double level) {
  Require(replicates.size() == standard_errors.size(), "a standard error of every replicate");
  std::vector<double> t(replicates.size());
  for (std::size_t i = 0; i < t.size(); ++i) {
    t[i] = (replicates[i] - estimate) / standard_errors[i];
  }
  const Interval quantiles = PercentileInterval(t, level);
  return {level, estimate - quantiles.upper * standard_error,
          estimate - quantiles.lower * standard_error};
}

Interval BcaInterval(double estimate, double acceleration, std::span<const double> replicates,
                     double level) {
  const std::vector<double> sorted = Sorted(replicates);
  const double bias = MedianBias(estimate, sorted);
  const double tail = 0.5 * (1.0 - level);
  return {level, Quantile(sorted, CorrectedShare(tail, bias, acceleration)),
          Quantile(sorted, CorrectedShare(1.0 - tail, bias, acceleration))};
}

double JackknifeAcceleration(std::span<const double> leave_one_out) {
  const double mean = std::accumulate(leave_one_out.begin(), leave_one_out.end(), 0.0) /
                      static_cast<double>(leave_one_out.size());
  double squares = 0.0;
  double cubes = 0.0;
  for (const double value : leave_one_out) {
    squares += std::pow(mean - value, 2);
    cubes += std::pow(mean - value, 3);
  }
  return squares > 0.0 ? cubes / (6.0 * std::pow(squares, 1.5)) : 0.0;
}

Interval Unbounded(double level) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  return {level, -kInfinity, kInfinity};
}

}  // namespace telltale
