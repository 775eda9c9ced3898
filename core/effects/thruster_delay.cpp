#include "telltale/core/effects/effect_instance.hpp"
#include "telltale/core/effects/wording.hpp"

namespace telltale {

class ThrusterDelayEffect final : public Effect {
 public:
  ThrusterDelayEffect()
      : Effect({.name = "thruster_delay",
                .title = "commands that come late",
                .equation = "delta(t) -> delta(t - d)",
                .source = "Dead time of a speed controller or a link, Fossen 2011, chapter 9",
                .parameters = {{"delay", "s", 0.2, 0.0, 1.5}},
                .settled_by = "the speed of the propellers"}) {}

  std::string Describe(EffectValues values) const override {
    return "commands reach the thrusters " + FormatNumber(values[0], 2) + " s late";
  }

  double CommandDelayS(EffectValues values) const override { return values[0]; }
};

template const Effect& InstanceOf<ThrusterDelayEffect>();

}  // namespace telltale
