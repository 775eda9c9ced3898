#include "effects/wording.hpp"

#include <array>
#include <cmath>
#include <cstdio>

#include "vessel/compass.hpp"

namespace telltale {

std::string Number(double value, int decimals) {
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), "%.*f", decimals, value);
  return text.data();
}

std::string Percent(double share) {
  return Number(100.0 * std::abs(share), 0) + " %";
}

std::string PercentMoreOrLess(double share) {
  return Percent(share) + (share < 0.0 ? " less" : " more");
}

std::string Towards(double north, double east) {
  const std::size_t point = NearestCompassPoint(std::atan2(east, north));
  return "towards " + std::string(kCompassPoints[point]);
}

}  // namespace telltale
