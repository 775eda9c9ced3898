#include <algorithm>

#include "telltale/core/effects/effect_instance.hpp"
#include "telltale/core/effects/wording.hpp"

namespace telltale {

class ThrustInflowLossEffect final : public Effect {
 public:
  ThrustInflowLossEffect()
      : Effect({.name = "thrust_inflow_loss",
                .title = "thrust that falls with speed",
                .equation = "T -> (1 - k max(u_r sign(T), 0)) T",
                .source = "Propeller in open water: thrust falls with the advance ratio, Fossen "
                          "2011, chapter 9",
                .parameters = {{"loss_per_speed", "s/m", 0.1, 0.0, 0.9}},
                .settled_by = "a log of speed through the water",
                .hook = Hook::kThrustShare}) {}

  std::string Describe(EffectValues values) const override {
    return "thrust " + Percent(values[0]) + " less for each m/s ahead";
  }

  double ThrustShare(EffectValues values, Side side, const InstantState& instant) const override {
    const double thrust = instant.thrust[side == Side::kPort ? 0 : 1].u;
    const double inflow = thrust < 0.0 ? -instant.nu_r.u : instant.nu_r.u;
    return std::max(1.0 - values[0] * std::max(inflow, 0.0), 0.0);
  }
};

template const Effect& InstanceOf<ThrustInflowLossEffect>();

}  // namespace telltale
