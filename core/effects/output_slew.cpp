#include "telltale/core/effects/effect_instance.hpp"
#include "telltale/core/effects/wording.hpp"

namespace telltale {

class OutputSlewEffect final : public Effect {
 public:
  OutputSlewEffect()
      : Effect({.name = "output_slew",
                .title = "outputs that change slowly",
                .equation = "|d delta_out / dt| <= 1 / t towards delta",
                .source =
                    "Van Amerongen 1982, the rate limit of a steering machine, in Fossen 2021, "
                    "chapter 9; the slew rate of a speed controller",
                .parameters = {{"travel_time", "s", 0.5, 0.0, 5.0}},
                .settled_by = "the speed of the propellers"}) {}

  std::string Describe(EffectValues values) const override {
    return "outputs take " + FormatNumber(values[0], 2) + " s from neutral to full";
  }

  double OutputTravelS(EffectValues values) const override { return values[0]; }
};

template const Effect& InstanceOf<OutputSlewEffect>();

}  // namespace telltale
