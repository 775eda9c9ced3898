#include <algorithm>
#include <cmath>

#include "telltale/core/effects/effect_instance.hpp"
#include "telltale/core/effects/wording.hpp"

namespace telltale {

class ThrusterDeadZoneEffect final : public Effect {
 public:
  ThrusterDeadZoneEffect()
      : Effect({.name = "thruster_dead_zone",
                .title = "a wider dead zone of the thrusters",
                .equation = "f(delta) -> f(sign(delta) max(|delta| - z, 0))",
                .source = "BlueRobotics T200 at 16 V: no thrust from 1471 to 1529 us; the paper, "
                          "remark on the dead zone",
                .parameters = {{"width", "1", 0.06, 0.0, 0.4}},
                .settled_by = "the speed of the propellers",
                .hook = Hook::kCommand}) {}

  std::string Describe(EffectValues values) const override {
    return "no thrust within " + Percent(values[0]) + " of full command more than modelled";
  }

  double Command(EffectValues values, Side, double delta) const override {
    return std::copysign(std::max(std::abs(delta) - values[0], 0.0), delta);
  }
};

template const Effect& InstanceOf<ThrusterDeadZoneEffect>();

}  // namespace telltale
