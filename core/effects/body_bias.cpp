#include "telltale/core/effects/effect_instance.hpp"
#include "telltale/core/effects/wording.hpp"

namespace telltale {

class BodyBiasEffect final : public Effect {
 public:
  BodyBiasEffect()
      : Effect({.name = "body_bias",
                .title = "a constant force that turns with the boat",
                .equation = "nu_dot += (X0, Y0, N0)",
                .source = "Fossen 2011, chapter 8, forces constant in the body frame",
                .parameters = {{"surge", "m/s^2", 0.05, -1.0, 1.0},
                               {"sway", "m/s^2", 0.05, -1.0, 1.0},
                               {"yaw", "rad/s^2", 0.05, -1.0, 1.0}},
                .settled_by = "an anemometer and a look below the waterline",
                .hook = Hook::kAcceleration,
                .nominal_variation = NominalVariation::kInCoefficients}) {}

  std::string Describe(EffectValues values) const override {
    return "a constant acceleration of " + FormatNumber(values[0], 3) + " m/s^2 ahead, " +
           FormatNumber(values[1], 3) + " m/s^2 to starboard and " + FormatNumber(values[2], 3) +
           " rad/s^2 to starboard";
  }

  NuDot AddedAcceleration(EffectValues values, const InstantState&) const override {
    return {values[0], values[1], values[2]};
  }
};

template const Effect& InstanceOf<BodyBiasEffect>();

}  // namespace telltale
