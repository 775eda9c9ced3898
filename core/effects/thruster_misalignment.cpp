#include <cmath>
#include <numbers>

#include "telltale/core/effects/effect_instance.hpp"
#include "telltale/core/effects/wording.hpp"

namespace telltale {
namespace {

// m11 / m22 of the default hull: sway answers a force with less acceleration.
constexpr double kSwayRatio = 0.7;

}  // namespace

class ThrusterMisalignmentEffect final : public Effect {
 public:
  ThrusterMisalignmentEffect()
      : Effect({.name = "thruster_misalignment",
                .title = "thrusters that do not push straight ahead",
                .equation =
                    "nu_dot += X_T (cos g - 1, m11 / m22 sin g, -a (1.3 m / L) sin g), X_T the "
                    "acceleration by thrust",
                .source = "Fossen 2011, chapter 9: azimuth angle and lever arm of a thruster",
                .parameters = {{"angle", "rad", 0.035, -0.5, 0.5},
                               {"lever_ratio", "1/m", 1.5, 0.5, 7.0, true, 2.7}},
                .settled_by = "a look at how the thrusters are mounted",
                .hook = Hook::kAcceleration}) {}

  std::string Describe(EffectValues values) const override {
    return "thrust turned by " + FormatNumber(values[0] * 180.0 / std::numbers::pi, 1) + " deg";
  }

  NuDot AddedAcceleration(EffectValues values, const InstantState& instant) const override {
    const double ahead = instant.Thrust().u;
    const HullScale& hull = instant.hull_scale;
    const double sway_ratio = kSwayRatio / hull.SwayMassRatio();
    // An arm that goes with the length, over a radius of gyration squared that goes with its
    // square.
    const double lever_ratio = values[1] / hull.length;
    return {ahead * (std::cos(values[0]) - 1.0), ahead * sway_ratio * std::sin(values[0]),
            -ahead * lever_ratio * std::sin(values[0])};
  }
};

template const Effect& InstanceOf<ThrusterMisalignmentEffect>();

}  // namespace telltale
