#pragma once

#include <array>
#include <cstddef>
#include <string_view>

namespace telltale {

/// Clockwise from north.
inline constexpr std::array<std::string_view, 8> kCompassPoints = {"N", "NE", "E", "SE",
                                                                   "S", "SW", "W", "NW"};

/// The place in kCompassPoints of the point nearest to a heading. Requires: finite, any wrap.
std::size_t NearestCompassPoint(double psi_rad);

}  // namespace telltale
