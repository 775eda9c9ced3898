#include "telltale/core/effects/effect.hpp"
#include "telltale/core/effects/library.hpp"
#include "telltale/core/effects/wording.hpp"

namespace telltale {
namespace {

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
             .hook = Hook::kPush,
             .habit = Habit::kInCoefficients}) {}

  std::string Describe(EffectValues values) const override {
    return "drag across the hull " + PercentMoreOrLess(values[0]);
  }

  NuDot Push(EffectValues values, const Moment& moment) const override {
    return {0.0, values[0] * Cross(moment.hull[1]), values[0] * Cross(moment.hull[2])};
  }

 private:
  static double Cross(const std::array<double, 9>& hull) {
    return hull[0] + hull[1] + hull[2] + hull[3];
  }
};

}  // namespace

const Effect& CrossflowDrag() {
  static const CrossflowDragEffect effect;
  return effect;
}

}  // namespace telltale
