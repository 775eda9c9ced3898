#include "telltale/core/uncertainty/circular_interval.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "telltale/core/base/degrees.hpp"
#include "telltale/core/uncertainty/distributions.hpp"

namespace telltale {
namespace {

using std::numbers::pi;

double Wrapped(double angle_rad) {
  return Wrap360(angle_rad * kDegreesPerRadian) * kRadiansPerDegree;
}

/// So many neighbours in a ring, from the first of them on.
struct Arc {
  Eigen::Index first = 0;
  double probability = 0.0;
};

Arc LikeliestArc(const Eigen::ArrayXd& probabilities, Eigen::Index length) {
  Arc likeliest;
  for (Eigen::Index first = 0; first < probabilities.size(); ++first) {
    double sum = 0.0;
    for (Eigen::Index k = 0; k < length; ++k)
      sum += probabilities[(first + k) % probabilities.size()];
    if (sum > likeliest.probability) likeliest = {first, sum};
  }
  return likeliest;
}

CircularInterval OneArc(const Eigen::ArrayXd& probabilities, double level) {
  const double step = 2.0 * pi / static_cast<double>(probabilities.size());
  for (Eigen::Index length = 1; length < probabilities.size(); ++length) {
    const Arc arc = LikeliestArc(probabilities, length);
    if (arc.probability < level) continue;
    const double middle = static_cast<double>(arc.first) + 0.5 * static_cast<double>(length - 1);
    return {Wrapped(middle * step), 0.5 * static_cast<double>(length) * step, false};
  }
  return {0.0, pi, false};
}

/// An axis is a direction of twice the angle. The likelier of both ends is the centre.
CircularInterval AxisOf(const Eigen::ArrayXd& probabilities, double level) {
  const Eigen::Index half = probabilities.size() / 2;
  const CircularInterval doubled =
      OneArc(probabilities.head(half) + probabilities.tail(half), level);
  const double step = 2.0 * pi / static_cast<double>(probabilities.size());
  const auto at = static_cast<Eigen::Index>(std::lround(0.5 * doubled.centre_rad / step)) % half;
  const bool is_near = probabilities[at] >= probabilities[at + half];
  const double centre = 0.5 * doubled.centre_rad + (is_near ? 0.0 : pi);
  return {Wrapped(centre), 0.5 * doubled.half_width_rad, true};
}

}  // namespace

CircularInterval ShortestArc(const Eigen::ArrayXd& probabilities, double level) {
  const CircularInterval one = OneArc(probabilities, level);
  if (one.half_width_rad < 0.5 * pi) return one;
  const CircularInterval axis = AxisOf(probabilities, level);
  return axis.half_width_rad < 0.25 * pi ? axis : one;
}

CircularInterval DirectionOf(const Eigen::Vector2d& vector, const Eigen::Matrix2d& covariance,
                             double level) {
  const double size = vector.norm();
  if (size == 0.0) return {0.0, pi, false};
  const Eigen::Vector2d across = Eigen::Vector2d(-vector[1], vector[0]) / size;
  const double standard_error = std::sqrt(std::max(across.dot(covariance * across), 0.0)) / size;
  const double half_width = NormalQuantile(0.5 * (1.0 + level)) * standard_error;
  return {Wrapped(std::atan2(vector[1], vector[0])), std::min(half_width, pi), false};
}

}  // namespace telltale
