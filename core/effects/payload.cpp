#include <algorithm>

#include "effects/effect.hpp"
#include "effects/library.hpp"
#include "effects/wording.hpp"

namespace telltale {
namespace {

// Radius of gyration of a small catamaran, 0.3 of its length.
constexpr double kGyrationM = 0.4;

class PayloadEffect final : public Effect {
 public:
  PayloadEffect()
      : Effect({.name = "payload",
                .title = "more mass aboard",
                .equation = "M = [m(1+p), m p x; m p x, m(k^2 + p x^2)] in sway and yaw, (1 + p) "
                            "in surge, under the same forces, k = 0.4 m; Coriolis terms as they "
                            "are",
                .source = "Fossen 2011, chapter 3: rigid-body mass and inertia",
                .parameters = {{"mass_gain", "1", 0.2, -0.6, 2.0},
                               {"forward_m", "m", 0.2, -0.6, 0.6, true, 0.0}},
                .settled_by = "a scale",
                .hook = Hook::kPush,
                .habit = Habit::kInCoefficients}) {}

  std::string Describe(EffectValues values) const override {
    return Percent(values[0]) + (values[0] < 0.0 ? " less mass" : " more mass");
  }

  NuDot Push(EffectValues values, const Moment& moment) const override {
    const double p = values[0];
    const double x = values[1];
    const NuDot thrust = moment.Thrust();
    const auto& [surge, sway, yaw] = moment.hull;
    const double surge_force = thrust.u + surge[0] + surge[3] + surge[4];
    const double sway_force = thrust.v + Drag(sway);
    const double yaw_moment = thrust.r + Drag(yaw);
    // Per unit of the boat's own mass and inertia.
    const double lever = p * x / (kGyrationM * kGyrationM);
    const double inertia = 1.0 + lever * x;
    const double determinant = std::max(1.0 + p + lever * x, 0.1);
    return {surge_force / (1.0 + p) - surge_force,
            (inertia * sway_force - p * x * yaw_moment) / determinant - sway_force,
            ((1.0 + p) * yaw_moment - lever * sway_force) / determinant - yaw_moment};
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
