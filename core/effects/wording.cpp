#include "telltale/core/effects/wording.hpp"

#include <cmath>

#include "telltale/core/vessel/compass.hpp"

namespace telltale {

std::string Percent(double share) {
  return FormatNumber(100.0 * std::abs(share), 0) + " %";
}

std::string PercentMoreOrLess(double share) {
  return Percent(share) + (share < 0.0 ? " less" : " more");
}

std::string Enumerated(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text.append(text.empty() ? "" : " and ").append(name);
  return text;
}

std::string Towards(double north, double east) {
  const std::size_t point = NearestCompassPoint(std::atan2(east, north));
  return "towards " + std::string(kCompassPoints[point]);
}

}  // namespace telltale
