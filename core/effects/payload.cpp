#include <algorithm>

#include "effects/effect.hpp"
#include "effects/library.hpp"
#include "effects/wording.hpp"

namespace telltale {
namespace {

class PayloadEffect final : public Effect {
 public:
  PayloadEffect()
      : Effect({.name = "payload",
                .title = "more mass aboard",
                .equation = "(1 + p) u_dot, (1 + p) v_dot and (1 + b p) r_dot under the same "
                            "forces; Coriolis terms as they are",
                .source = "Fossen 2011, chapter 3: rigid-body mass and inertia",
                .parameters = {{"mass_gain", "1", 0.2, -0.6, 2.0},
                               {"inertia_ratio", "1", 0.5, 0.3, 2.0, true, 1.0}},
                .settled_by = "a scale",
                .hook = Hook::kPush,
                .habit = Habit::kInCoefficients}) {}

  std::string Describe(EffectValues values) const override {
    return Percent(values[0]) + (values[0] < 0.0 ? " less mass" : " more mass");
  }

  NuDot Push(EffectValues values, const Moment& moment) const override {
    const double linear = 1.0 / (1.0 + values[0]) - 1.0;
    const double turning = 1.0 / std::max(1.0 + values[1] * values[0], 0.1) - 1.0;
    const NuDot thrust = moment.Thrust();
    const auto& [surge, sway, yaw] = moment.hull;
    return {linear * (thrust.u + surge[0] + surge[3] + surge[4]), linear * (thrust.v + Drag(sway)),
            turning * (thrust.r + Drag(yaw))};
  }

 private:
  // All but the terms in uv and ur, which mass scales as it scales the left side.
  static double Drag(const std::array<double, 9>& hull) {
    return hull[0] + hull[1] + hull[2] + hull[3] + hull[6] + hull[7] + hull[8];
  }
};

}  // namespace

const Effect& Payload() {
  static const PayloadEffect effect;
  return effect;
}

}  // namespace telltale
