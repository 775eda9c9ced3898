#include "uncertainty/interval.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>

#include "contract.hpp"

namespace telltale {
namespace {

double Quantile(const std::vector<double>& sorted, double share) {
  const double position = share * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(std::floor(position));
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  return std::lerp(sorted[below], sorted[above], position - static_cast<double>(below));
}

}  // namespace

Interval StudentInterval(double estimate, double standard_error, double degrees_of_freedom,
                         double level) {
  const boost::math::students_t distribution(degrees_of_freedom);
  const double half = standard_error * boost::math::quantile(distribution, 0.5 * (1.0 + level));
  return {level, estimate - half, estimate + half};
}

Interval NormalInterval(double estimate, double standard_error, double level) {
  const double half =
      standard_error * boost::math::quantile(boost::math::normal(), 0.5 * (1.0 + level));
  return {level, estimate - half, estimate + half};
}

Interval PercentileInterval(std::span<const double> replicates, double level) {
  Require(replicates.size() > 1, "at least two replicates");
  std::vector<double> sorted(replicates.begin(), replicates.end());
  std::sort(sorted.begin(), sorted.end());
  const double tail = 0.5 * (1.0 - level);
  return {level, Quantile(sorted, tail), Quantile(sorted, 1.0 - tail)};
}

Interval Unbounded(double level) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  return {level, -kInfinity, kInfinity};
}

}  // namespace telltale
