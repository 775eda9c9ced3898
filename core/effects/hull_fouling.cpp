#include <cmath>

#include "telltale/core/effects/effect_instance.hpp"
#include "telltale/core/effects/wording.hpp"

namespace telltale {
namespace {

constexpr double kStill = 1e-6;  // m/s: no drag, and no slope of it

}  // namespace

class HullFoulingEffect final : public Effect {
 public:
  HullFoulingEffect()
      : Effect(
            {.name = "hull_fouling",
             .title = "a fouled hull",
             .equation =
                 "X_|u|u and X_u -> (1 + k) times as large, and as the outer hull of a turn is "
                 "the faster one, r_dot += k q c d(X_|u|u |u| u + X_u u)/du r, c = (B / 0.8 m)^2 "
                 "(1.3 m / L)^2",
             .source = "Schultz, Effects of coating roughness and biofouling on ship "
                       "resistance, Biofouling 23, 2007",
             .parameters = {{"drag_gain", "1", 0.25, -0.9, 4.0},
                            {"turning_ratio", "1", 0.5, 0.0, 2.0, true, 0.5}},
             .settled_by = "a look below the waterline",
             .hook = Hook::kAcceleration,
             .nominal_variation = NominalVariation::kInCoefficients}) {}

  std::string Describe(EffectValues values) const override {
    return "drag ahead " + PercentMoreOrLess(values[0]);
  }

  NuDot AddedAcceleration(EffectValues values, const InstantState& instant) const override {
    const double quadratic = instant.hull.surge[0];
    const double linear = instant.hull.surge[3];
    const double u = instant.nu_r.u;
    const double slope = std::abs(u) < kStill ? 0.0 : (2.0 * quadratic + linear) / u;
    // The arms of the two hulls over the radius of gyration, squared.
    const double beam_to_length = instant.hull_scale.beam / instant.hull_scale.length;
    const double turning_ratio = values[1] * (beam_to_length * beam_to_length);
    return {values[0] * (quadratic + linear), 0.0,
            values[0] * turning_ratio * slope * instant.nu_r.r};
  }
};

template const Effect& InstanceOf<HullFoulingEffect>();

}  // namespace telltale
