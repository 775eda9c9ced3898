#include "telltale/core/effects/effect_instance.hpp"
#include "telltale/core/effects/load.hpp"
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
    return LoadedLess(instant.Acceleration(), {values[0], values[1], 0.0}, instant);
  }
};

template const Effect& InstanceOf<PayloadEffect>();

}  // namespace telltale
