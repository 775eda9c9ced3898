#include <algorithm>

#include "telltale/core/effects/effect_instance.hpp"
#include "telltale/core/effects/wording.hpp"

namespace telltale {

class ThrusterImbalanceEffect final : public Effect {
 public:
  ThrusterImbalanceEffect()
      : Effect(
            {.name = "thruster_imbalance",
             .title = "one thruster weaker than the other",
             .equation =
                 "T_port -> (1 - e) T_port for e > 0, T_starboard -> (1 + e) T_starboard for e < 0",
             .source = "A chipped, fouled or misconfigured propeller: thrust goes with the fourth "
                       "power of its diameter, Fossen 2011, chapter 9",
             .parameters = {{"port_loss", "1", 0.2, -0.9, 0.9}},
             .settled_by = "the current drawn by each thruster",
             .hook = Hook::kThrustShare}) {}

  std::string Describe(EffectValues values) const override {
    return (values[0] < 0.0 ? "starboard thruster " : "port thruster ") + Percent(values[0]) +
           " weaker";
  }

  double ThrustShare(EffectValues values, Side side, const InstantState&) const override {
    const double loss = side == Side::kPort ? values[0] : -values[0];
    return 1.0 - std::max(loss, 0.0);
  }
};

template const Effect& InstanceOf<ThrusterImbalanceEffect>();

}  // namespace telltale
