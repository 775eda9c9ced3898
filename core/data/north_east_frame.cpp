#include "telltale/core/data/north_east_frame.hpp"

#include <cmath>

namespace telltale {

NorthEastFrame::NorthEastFrame(const FrameOrigin& origin)
    : plane_(origin.latitude_deg, origin.longitude_deg, 0.0) {}

NorthEastPosition NorthEastFrame::Forward(const GeographicPosition& position) const {
  double east = 0.0;
  double north = 0.0;
  double up = 0.0;
  plane_.Forward(position.latitude_deg, position.longitude_deg, 0.0, east, north, up);
  return {north, east};
}

GeographicPosition NorthEastFrame::Inverse(const NorthEastPosition& position) const {
  // The height of the ellipsoid below the plane is unknown at first. Each pass removes the
  // remaining height, which shrinks by (d / R)^2. A height displaces the position below it by d / R
  // of it.
  constexpr int kMostPasses = 4;
  constexpr double kNoHeightM = 1e-6;
  GeographicPosition on_ellipsoid;
  double up = 0.0;
  for (int pass = 0; pass < kMostPasses; ++pass) {
    double height = 0.0;
    plane_.Reverse(position.east_m, position.north_m, up, on_ellipsoid.latitude_deg,
                   on_ellipsoid.longitude_deg, height);
    if (std::abs(height) < kNoHeightM) break;
    up -= height;
  }
  return on_ellipsoid;
}

}  // namespace telltale
