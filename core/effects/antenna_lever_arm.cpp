#include "telltale/core/effects/effect_instance.hpp"
#include "telltale/core/effects/wording.hpp"

namespace telltale {

class AntennaLeverArmEffect final : public Effect {
 public:
  AntennaLeverArmEffect()
      : Effect(
            {.name = "antenna_lever_arm",
             .title = "an antenna elsewhere than stated",
             .equation = "p_antenna = p + R(psi) (l + s)",
             .source = "Fossen 2011, chapter 11: GNSS lever arm",
             .parameters = {{"forward", "m", 0.3, -3.0, 3.0}, {"starboard", "m", 0.3, -3.0, 3.0}},
             .settled_by = "a tape measure"}) {}

  std::string Describe(EffectValues values) const override {
    return "antenna " + FormatNumber(values[0], 2) + " m further forward and " +
           FormatNumber(values[1], 2) + " m further to starboard than stated";
  }

  LeverArm AntennaShift(EffectValues values) const override { return {values[0], values[1]}; }
};

template const Effect& InstanceOf<AntennaLeverArmEffect>();

}  // namespace telltale
