#pragma once

#include <GeographicLib/LocalCartesian.hpp>

namespace telltale {

/// The origin of {n}.
struct FrameOrigin {
  double latitude_deg = 0.0;
  double longitude_deg = 0.0;
};

struct GeographicPosition {
  double latitude_deg = 0.0;
  double longitude_deg = 0.0;
};

/// Metres in the plane of {n}.
struct NorthEastPosition {
  double north_m = 0.0;
  double east_m = 0.0;
};

/// The local tangent plane of {n}: converts WGS84 positions on the ellipsoid to and from metres
/// north and east.
/// Assumes: positions at the height of the ellipsoid, since a boat floats. The plane departs from
/// the surface by d^2 / (2 R), 8 cm at 1 km.
/// Errors: Inverse(Forward(p)) returns p to 1e-9 degrees within 100 km.
/// Source: Karney, GeographicLib, LocalCartesian.
class NorthEastFrame {
 public:
  explicit NorthEastFrame(const FrameOrigin& origin);

  NorthEastPosition Forward(const GeographicPosition& position) const;
  GeographicPosition Inverse(const NorthEastPosition& position) const;

 private:
  GeographicLib::LocalCartesian plane_;
};

}  // namespace telltale
