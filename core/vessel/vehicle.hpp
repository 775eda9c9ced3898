#pragma once

#include <optional>
#include <string>

#include "telltale/core/vessel/propellers.hpp"

namespace telltale {

/// The position of the GNSS antenna from the body origin. Units: metres.
struct LeverArm {
  double forward_m = 0.0;
  double starboard_m = 0.0;
};

/// Particulars of a hull that scale the effects of the diagnosis and that no recording shows.
/// Defaults: the catamaran of 1.3 m whose effects the library's coefficients describe. All > 0.
struct HullParticulars {
  double length_m = 1.3;          ///< of the waterline
  double beam_m = 0.8;            ///< over all
  double draught_m = 0.12;        ///< of the deepest hull
  double frontal_area_m2 = 0.25;  ///< above water, seen from ahead
  double lateral_area_m2 = 0.4;   ///< above water, seen from the side
  double mass_kg = 35.0;          ///< without added mass
};

/// One boat as its operator states it: identity, geometry and thruster channels.
struct Vehicle {
  std::string vehicle_id;
  double propeller_separation_m = 0.0;
  PwmChannel port;
  PwmChannel starboard;
  LeverArm gnss_antenna;
  std::optional<double> mass_kg;
  std::optional<HullParticulars> hull = {};  ///< its mass is `mass_kg`, where that is stated

  /// The hull as stated. A file without `hull` describes the default hull, with its default mass:
  /// the areas of one boat and the mass of another would scale neither.
  HullParticulars HullOrDefault() const {
    HullParticulars particulars = hull.value_or(HullParticulars{});
    if (hull && mass_kg) particulars.mass_kg = *mass_kg;
    return particulars;
  }

  PropellerCommand Normalise(double port_us, double starboard_us) const {
    return {port.Normalise(port_us), starboard.Normalise(starboard_us)};
  }
};

}  // namespace telltale
