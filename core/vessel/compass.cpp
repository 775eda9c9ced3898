#include "telltale/core/vessel/compass.hpp"

#include <cmath>
#include <numbers>

namespace telltale {

std::size_t NearestCompassPoint(double psi_rad) {
  constexpr auto kPoints = static_cast<long>(kCompassPoints.size());
  const long eighths = std::lround(psi_rad / (std::numbers::pi / 4.0)) % kPoints;
  return static_cast<std::size_t>((eighths + kPoints) % kPoints);
}

}  // namespace telltale
