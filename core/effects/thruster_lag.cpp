#include "telltale/core/effects/effect_instance.hpp"
#include "telltale/core/effects/wording.hpp"

namespace telltale {

class ThrusterLagEffect final : public Effect {
 public:
  ThrusterLagEffect()
      : Effect({.name = "thruster_lag",
                .title = "thrusters that lag",
                .equation = "tau dn/dt = n_c - n of the shafts' speed n, with T = n abs(n)",
                .source = "Yoerger, Cooke and Slotine 1990: the shaft's speed is the state",
                .parameters = {{"time_constant", "s", 0.2, 0.0, 2.0}},
                .settled_by = "the speed of the propellers"}) {}

  std::string Describe(EffectValues values) const override {
    return "thrusters follow commands " + FormatNumber(values[0], 2) + " s more slowly";
  }

  double ShaftLagS(EffectValues values) const override { return values[0]; }
};

template const Effect& InstanceOf<ThrusterLagEffect>();

}  // namespace telltale
