#include <cmath>

#include "telltale/core/effects/effect.hpp"
#include "telltale/core/effects/effect_library.hpp"
#include "telltale/core/effects/wording.hpp"

namespace telltale {
namespace {

constexpr double kStill = 1e-6;  // m/s: no drag, and no slope of it

class HullFoulingEffect final : public Effect {
 public:
  HullFoulingEffect()
      : Effect({.name = "hull_fouling",
                .title = "a fouled hull",
                .equation =
                    "X_|u|u and X_u -> (1 + k) times as large, and as the outer hull of a turn is "
                    "the faster one, r_dot += k q d(X_|u|u |u| u + X_u u)/du r",
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
    const double quadratic = instant.hull[0][0];
    const double linear = instant.hull[0][3];
    const double u = instant.nu_r.u;
    const double slope = std::abs(u) < kStill ? 0.0 : (2.0 * quadratic + linear) / u;
    return {values[0] * (quadratic + linear), 0.0, values[0] * values[1] * slope * instant.nu_r.r};
  }
};

}  // namespace

const Effect& HullFouling() {
  static const HullFoulingEffect effect;
  return effect;
}

}  // namespace telltale
