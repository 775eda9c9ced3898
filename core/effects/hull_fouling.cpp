#include "effects/effect.hpp"
#include "effects/library.hpp"
#include "effects/wording.hpp"

namespace telltale {
namespace {

class HullFoulingEffect final : public Effect {
 public:
  HullFoulingEffect()
      : Effect({.name = "hull_fouling",
                .title = "a fouled hull",
                .equation = "X_|u|u and X_u -> (1 + k) times as large",
                .source = "Schultz, Effects of coating roughness and biofouling on ship "
                          "resistance, Biofouling 23, 2007",
                .parameters = {{"drag_gain", "1", 0.25, -0.9, 4.0}},
                .settled_by = "a look below the waterline",
                .hook = Hook::kPush,
                .habit = Habit::kInCoefficients}) {}

  std::string Describe(EffectValues values) const override {
    return "drag ahead " + PercentMoreOrLess(values[0]);
  }

  NuDot Push(EffectValues values, const Moment& moment) const override {
    return {values[0] * (moment.hull[0][0] + moment.hull[0][3]), 0.0, 0.0};
  }
};

}  // namespace

const Effect& HullFouling() {
  static const HullFoulingEffect effect;
  return effect;
}

}  // namespace telltale
