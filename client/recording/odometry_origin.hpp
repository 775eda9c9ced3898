#pragma once

#include <string>

#include "telltale/core/data/north_east_frame.hpp"

namespace telltale {

/// Where metres are taken to begin whose origin a recording does not state. Models do not depend on
/// the place.
inline constexpr FrameOrigin kOdometryOrigin{45.0, 0.0};

/// The place of metres north and east of it. Requires: finite numbers.
inline GeographicPosition PlaceOfOdometry(const NorthEastPosition& metres) {
  static const NorthEastFrame frame(kOdometryOrigin);
  return frame.Inverse(metres);
}

/// For people.
inline std::string OdometryOriginText() {
  return "an origin that is not stated, taken as 45 N 0 E";
}

}  // namespace telltale
