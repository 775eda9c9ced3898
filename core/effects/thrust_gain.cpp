#include "telltale/core/effects/effect_instance.hpp"
#include "telltale/core/effects/wording.hpp"

namespace telltale {

class ThrustGainEffect final : public Effect {
 public:
  ThrustGainEffect()
      : Effect({.name = "thrust_gain",
                .title = "weaker thrust on both sides",
                .equation = "T -> (1 - e) T",
                .source = "Battery voltage or propellers other than in the model",
                .parameters = {{"loss", "1", 0.1, -1.0, 0.9}},
                .settled_by = "the battery voltage",
                .hook = Hook::kThrustShare,
                .nominal_variation = NominalVariation::kInCoefficients}) {}

  std::string Describe(EffectValues values) const override {
    return "thrust of both thrusters " + PercentMoreOrLess(-values[0]);
  }

  double ThrustShare(EffectValues values, Side, const InstantState&) const override {
    return 1.0 - values[0];
  }
};

template const Effect& InstanceOf<ThrustGainEffect>();

}  // namespace telltale
