#include "telltale/core/effects/effect_instance.hpp"
#include "telltale/core/effects/wording.hpp"

namespace telltale {

class OutputStuckEffect final : public Effect {
 public:
  OutputStuckEffect()
      : Effect({.name = "output_stuck",
                .title = "an output that is stuck",
                .equation = "delta_port -> (1 - k_p) delta_port + k_p h, delta_starboard likewise "
                            "with k_s; k = 1 is stuck at h throughout",
                .source = "Blanke, Kinnaert, Lunze and Staroswiecki, Diagnosis and Fault-Tolerant "
                          "Control, 2016: an actuator locked in place",
                .parameters = {{"port_share", "1", 0.4, 0.0, 1.0},
                               {"starboard_share", "1", 0.4, 0.0, 1.0},
                               {"held_at", "1", 0.5, -1.0, 1.0, true, 0.0}},
                .settled_by = "the speed of the propellers",
                .hook = Hook::kCommand,
                .nominal_variation = NominalVariation::kNone,
                .is_all_or_nothing = true}) {}

  std::string Describe(EffectValues values) const override {
    const bool is_starboard = values[1] > values[0];
    return (is_starboard ? "starboard output " : "port output ") +
           Percent(values[is_starboard ? 1 : 0]) + " stuck at a command of " +
           FormatNumber(values[2], 2);
  }

  double Command(EffectValues values, Side side, double delta) const override {
    const double share = values[side == Side::kPort ? 0 : 1];
    return (1.0 - share) * delta + share * values[2];
  }
};

template const Effect& InstanceOf<OutputStuckEffect>();

}  // namespace telltale
