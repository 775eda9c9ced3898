#include "telltale/core/effects/effect_instance.hpp"
#include "telltale/core/effects/wording.hpp"

namespace telltale {

class CrossflowDragEffect final : public Effect {
 public:
  CrossflowDragEffect()
      : Effect(
            {.name = "crossflow_drag",
             .title = "other drag across the hull",
             .equation =
                 "the terms in v|v|, v|r|, r|v| and r|r| of sway and yaw -> (1 + k) times as large",
             .source = "Fossen 2011, chapter 6: cross-flow drag",
             .parameters = {{"drag_gain", "1", 0.5, -0.95, 4.0}},
             .settled_by = "a look below the waterline",
             .hook = Hook::kAcceleration,
             .nominal_variation = NominalVariation::kInCoefficients}) {}

  std::string Describe(EffectValues values) const override {
    return "drag across the hull " + PercentMoreOrLess(values[0]);
  }

  NuDot AddedAcceleration(EffectValues values, const InstantState& instant) const override {
    return {0.0, values[0] * Cross(instant.hull.sway), values[0] * Cross(instant.hull.yaw)};
  }

 private:
  static double Cross(const std::array<double, 9>& hull) {
    return hull[0] + hull[1] + hull[2] + hull[3];
  }
};

template const Effect& InstanceOf<CrossflowDragEffect>();

}  // namespace telltale
