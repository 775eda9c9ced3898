#include "telltale/core/effects/effect.hpp"
#include "telltale/core/effects/effect_library.hpp"
#include "telltale/core/effects/wording.hpp"

namespace telltale {
namespace {

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

}  // namespace

const Effect& ThrustGain() {
  static const ThrustGainEffect effect;
  return effect;
}

}  // namespace telltale
