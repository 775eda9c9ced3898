#include <cmath>

#include "telltale/core/effects/effect_instance.hpp"
#include "telltale/core/effects/wording.hpp"

namespace telltale {
namespace {

// Half the density of air times drag coefficient, area and, in yaw, length, over mass or inertia
// with added mass: of the default hull, with drag coefficients of 0.69, 0.88 and 0.105. Units: 1/m,
// 1/m, 1/m^2.
constexpr double kSurgeDrag = 0.0028;
constexpr double kSwayDrag = 0.0040;
constexpr double kYawDrag = 0.0045;
// Of areas that few vehicle files state, and of drag coefficients, from boat to boat. The force
// says no more of the wind than the drag allows.
constexpr double kDragSpread = 0.3;
// Turbulence intensity: scatter of the speed over its mean, low over sheltered water.
constexpr double kTurbulence = 0.2;
// Gusts that move a boat last 3 to 20 s; this is their geometric mean.
constexpr double kGustTimeS = 8.0;

}  // namespace

class WindEffect final : public Effect {
 public:
  WindEffect()
      : Effect({.name = "wind",
                .title = "wind",
                .equation = "nu_dot += d (kx |V_rw| V_rw,x, ky a |V_rw| V_rw,y, kn b V_rw,x V_rw,y "
                            "+ s L (m + A22) / (I + A66) ky a |V_rw| V_rw,y), "
                            "V_rw = R(psi)' V_w - nu, less the same in still air; kx ~ A_F / m, "
                            "ky ~ A_L / (m + A22), kn ~ A_L / ((1 + A66 / I) m L); s L is how far "
                            "the centre of the lateral area is ahead",
                .source = "Blendermann, Parameter identification of wind loads on ships, J. Wind "
                          "Eng. Ind. Aerodyn. 51, 1994; Fossen 2011, chapter 8",
                .parameters = {{"wind_north", "m/s", 4.0, -25.0, 25.0},
                               {"wind_east", "m/s", 4.0, -25.0, 25.0},
                               {"side_ratio", "1", 0.5, 0.3, 3.0, true, 1.0},
                               {"yaw_ratio", "1", 1.0, -3.0, 3.0, true, 0.0},
                               {"area_centre", "1", 0.1, -0.4, 0.4, true, 0.0},
                               {"drag_ratio", "1", kDragSpread, 0.4, 2.5, true, 1.0}},
                .settled_by = "an anemometer",
                .hook = Hook::kAcceleration,
                .nominal_variation = NominalVariation::kRecordingEffect,
                .turbulence_intensity = kTurbulence,
                .turbulence_time_s = kGustTimeS,
                .is_weather = true,
                .length_name = "speed",
                .is_north_east = true}) {}

  std::string Describe(EffectValues values) const override {
    return FormatNumber(std::hypot(values[0], values[1]), 1) + " m/s of wind " +
           Towards(values[0], values[1]);
  }

  NuDot AddedAcceleration(EffectValues values, const InstantState& instant) const override {
    const double c = std::cos(instant.psi_rad);
    const double s = std::sin(instant.psi_rad);
    const Nu& nu = instant.nu;
    const double relative_forward = c * values[0] + s * values[1] - nu.u;
    const double relative_starboard = -s * values[0] + c * values[1] - nu.v;
    const double speed = std::hypot(relative_forward, relative_starboard);
    // The drag of still air is in the coefficients of the hull already.
    const double still = std::hypot(nu.u, nu.v);
    const HullScale& hull = instant.hull_scale;
    const double drag_ratio = values[5];
    const double surge = kSurgeDrag * drag_ratio * (hull.frontal_area / hull.mass);
    const double sway =
        kSwayDrag * drag_ratio * (hull.lateral_area / (hull.mass * hull.SwayMassRatio()));
    const double from_side = sway * values[2] * (speed * relative_starboard + still * nu.v);
    const double yaw = kYawDrag * drag_ratio *
                       (hull.lateral_area / (hull.mass * hull.length * hull.YawInertiaRatio()));
    return {surge * (speed * relative_forward + still * nu.u), from_side,
            yaw * values[3] * (relative_forward * relative_starboard - nu.u * nu.v) +
                values[4] * hull.length_m * hull.SwayOverYawInertia() * from_side};
  }
};

template const Effect& InstanceOf<WindEffect>();

}  // namespace telltale
