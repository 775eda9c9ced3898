#pragma once

#include "telltale/core/vessel/vehicle.hpp"

namespace telltale {

/// How the hull of a vehicle file scales the coefficients that effects have for the default hull.
/// Each member but the lengths in metres is a ratio; for HullParticulars{} all ratios are exactly
/// one. Model: strip theory for the added mass of slender hulls, A22 ~ T^2 L and A66 ~ T^2 L^3
/// (Fossen 2011, chapter 6; Faltinsen 1990, section 3); inertia m k^2 with k ~ L.
struct HullScale {
  double length = 1.0;  ///< this and the next five: stated over default
  double beam = 1.0;
  double draught = 1.0;
  double frontal_area = 1.0;
  double lateral_area = 1.0;
  double mass = 1.0;
  double length_m = 1.3;
  double gyration_radius_m = 0.4;  ///< k = 0.4 m of a hull of 1.3 m, proportional to length
  /// (m + A22) / m, with A22 = 0.5 s m and s = (T / 0.12 m)^2 (L / 1.3 m) (35 kg / m).
  double sway_mass = 1.5;
  /// (I + A66) / I, with A66 = 0.3 s I: s of the sway, since A66 / A22 and I / m both go with L^2.
  double yaw_inertia = 1.3;

  HullScale() = default;
  explicit HullScale(const HullParticulars& hull) {
    constexpr HullParticulars kDefault;
    length = hull.length_m / kDefault.length_m;
    beam = hull.beam_m / kDefault.beam_m;
    frontal_area = hull.frontal_area_m2 / kDefault.frontal_area_m2;
    lateral_area = hull.lateral_area_m2 / kDefault.lateral_area_m2;
    mass = hull.mass_kg / kDefault.mass_kg;
    draught = hull.draught_m / kDefault.draught_m;
    length_m = hull.length_m;
    gyration_radius_m = 0.4 * length;
    const double added = draught * draught * length / mass;
    sway_mass = 1.0 + 0.5 * added;
    yaw_inertia = 1.0 + 0.3 * added;
  }

  /// (m + A22) / m and (I + A66) / I over those of the default hull.
  double SwayMassRatio() const { return sway_mass / 1.5; }
  double YawInertiaRatio() const { return yaw_inertia / 1.3; }
  /// (m + A22) / (I + A66), 1/m^2: the yaw acceleration of a force one metre ahead that alone gives
  /// a unit of sway acceleration.
  double SwayOverYawInertia() const {
    return sway_mass / (gyration_radius_m * gyration_radius_m * yaw_inertia);
  }
};

}  // namespace telltale
