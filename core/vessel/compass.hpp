#pragma once

#include <array>
#include <cstddef>
#include <string_view>

namespace telltale {

/// The eight compass points, clockwise from north.
inline constexpr std::array<std::string_view, 8> kCompassPoints = {"N", "NE", "E", "SE",
                                                                   "S", "SW", "W", "NW"};

/// The index in kCompassPoints of the point nearest to a heading. Requires: a finite heading; any
/// wrap.
std::size_t NearestCompassPoint(double psi_rad);

}  // namespace telltale
