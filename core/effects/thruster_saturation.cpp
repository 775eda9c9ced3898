#include <algorithm>

#include "telltale/core/effects/effect_instance.hpp"
#include "telltale/core/effects/wording.hpp"

namespace telltale {

class ThrusterSaturationEffect final : public Effect {
 public:
  ThrusterSaturationEffect()
      : Effect({.name = "thruster_saturation",
                .title = "commands that are cut off",
                .equation = "delta -> sign(delta) min(|delta|, 1 - s)",
                .source = "Current or power limits of a speed controller",
                .parameters = {{"cut", "1", 0.2, 0.0, 0.9}},
                .settled_by = "the speed of the propellers",
                .hook = Hook::kCommand}) {}

  std::string Describe(EffectValues values) const override {
    return "commands cut off at " + Percent(1.0 - values[0]) + " of full";
  }

  double Command(EffectValues values, Side, double delta) const override {
    return std::clamp(delta, values[0] - 1.0, 1.0 - values[0]);
  }
};

template const Effect& InstanceOf<ThrusterSaturationEffect>();

}  // namespace telltale
