#include "telltale/core/effects/effect_instance.hpp"
#include "telltale/core/effects/wording.hpp"

namespace telltale {

class AddedMassCouplingEffect final : public Effect {
 public:
  AddedMassCouplingEffect()
      : Effect({.name = "added_mass_coupling",
                .title = "another Munk moment",
                .equation = "r_dot += k u v, k = (m11 - m22) / m33",
                .source =
                    "Fossen 2011, chapter 6: the Munk moment in the Coriolis terms of added mass",
                .parameters = {{"moment", "1/m^2", 1.0, -8.0, 8.0}},
                .settled_by = "an inertial sensor",
                .hook = Hook::kAcceleration,
                .nominal_variation = NominalVariation::kInCoefficients}) {}

  std::string Describe(EffectValues values) const override {
    return "a Munk moment of " + FormatNumber(values[0], 2) + " u v more";
  }

  NuDot AddedAcceleration(EffectValues values, const InstantState& moment) const override {
    return {0.0, 0.0, values[0] * moment.nu_r.u * moment.nu_r.v};
  }
};

template const Effect& InstanceOf<AddedMassCouplingEffect>();

}  // namespace telltale
