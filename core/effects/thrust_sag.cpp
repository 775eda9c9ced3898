#include <algorithm>

#include "telltale/core/effects/effect_instance.hpp"
#include "telltale/core/effects/wording.hpp"

namespace telltale {

class ThrustSagEffect final : public Effect {
 public:
  ThrustSagEffect()
      : Effect({.name = "thrust_sag",
                .title = "thrust that fades with the battery",
                .equation = "T -> (1 - s t / t_end - l mean(delta^2)) T",
                .source = "Discharge and inner resistance of a lithium battery: thrust falls with "
                          "its voltage",
                .parameters = {{"loss_by_end", "1", 0.14, 0.0, 0.9},
                               {"loss_at_full_load", "1", 0.05, 0.0, 0.6}},
                .settled_by = "the battery voltage",
                .hook = Hook::kThrustShare}) {}

  std::string Describe(EffectValues values) const override {
    return "thrust " + Percent(values[0]) + " less by the end, and " + Percent(values[1]) +
           " less at full load";
  }

  double ThrustShare(EffectValues values, Side, const InstantState& instant) const override {
    const double faded = values[0] * instant.time_s / instant.span_s;
    return std::max(1.0 - faded - values[1] * instant.load, 0.0);
  }
};

template const Effect& InstanceOf<ThrustSagEffect>();

}  // namespace telltale
