#include <algorithm>
#include <array>
#include <numeric>

#include "telltale/core/effects/effect_instance.hpp"
#include "telltale/core/effects/wording.hpp"

namespace telltale {

class PayloadEffect final : public Effect {
 public:
  PayloadEffect()
      : Effect(
            {.name = "payload",
             .title = "more mass aboard",
             .equation = "a load p m at x forward: (1 + p) u_dot, (1 + p_v) v_dot + p_v x r_dot "
                         "and (1 + p_r x) r_dot + p_r v_dot are the boat's own + p (v r + x r^2), "
                         "- p_v u r, - p_r u r; p_v = p m / (m + A22), "
                         "p_r = p x I / ((I + A66) k^2), k = 0.31 L; in surge A11 is neglected",
             .source = "Fossen 2011, chapter 3: rigid-body mass, inertia and Coriolis terms of a "
                       "point mass; chapter 6 for added mass",
             .parameters = {{"mass_gain", "1", 0.2, -0.6, 2.0},
                            {"forward_m", "m", 0.2, -0.6, 0.6, true, 0.0}},
             .settled_by = "a scale",
             .hook = Hook::kAcceleration,
             .nominal_variation = NominalVariation::kInCoefficients}) {}

  std::string Describe(EffectValues values) const override {
    return Percent(values[0]) + (values[0] < 0.0 ? " less mass" : " more mass");
  }

  NuDot AddedAcceleration(EffectValues values, const InstantState& instant) const override {
    const double p = values[0];
    const double x = values[1];
    const Nu& nu = instant.nu;
    const NuDot thrust = instant.Thrust();
    const auto& [surge, sway, yaw] = instant.hull;
    const NuDot light = {thrust.u + Sum(surge), thrust.v + Sum(sway), thrust.r + Sum(yaw)};
    // The load's share of the boat's mass and inertia, added mass included.
    const HullScale& hull = instant.hull_scale;
    const double p_v = p / hull.sway_mass;
    const double p_r = p * x / (hull.yaw_inertia * hull.gyration_radius_m * hull.gyration_radius_m);
    const double side = light.v - p_v * nu.u * nu.r;
    const double turn = light.r - p_r * nu.u * nu.r;
    const double determinant = std::max((1.0 + p_v) * (1.0 + p_r * x) - p_v * x * p_r, 0.1);
    return {(light.u + p * (nu.v * nu.r + x * nu.r * nu.r)) / (1.0 + p) - light.u,
            ((1.0 + p_r * x) * side - p_v * x * turn) / determinant - light.v,
            ((1.0 + p_v) * turn - p_r * side) / determinant - light.r};
  }

 private:
  static double Sum(const std::array<double, 9>& hull) {
    return std::accumulate(hull.begin(), hull.end(), 0.0);
  }
};

template const Effect& InstanceOf<PayloadEffect>();

}  // namespace telltale
