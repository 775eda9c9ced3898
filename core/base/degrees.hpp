#pragma once

#include <cmath>
#include <numbers>

namespace telltale {

inline constexpr double kDegreesPerRadian = 180.0 / std::numbers::pi;
inline constexpr double kRadiansPerDegree = std::numbers::pi / 180.0;

/// The same direction in [0, 360).
inline double Wrap360(double angle_deg) {
  const double wrapped = angle_deg - 360.0 * std::floor(angle_deg / 360.0);
  return wrapped < 360.0 ? wrapped : 0.0;
}

}  // namespace telltale
