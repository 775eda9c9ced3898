#include "effects/wording.hpp"

#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>

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
  constexpr std::array<std::string_view, 8> kPoints = {"N", "NE", "E", "SE", "S", "SW", "W", "NW"};
  const double eighths = std::atan2(east, north) / (std::numbers::pi / 4.0);
  const auto point = static_cast<std::size_t>(std::lround(eighths) + 8) % kPoints.size();
  return "towards " + std::string(kPoints[point]);
}

}  // namespace telltale
