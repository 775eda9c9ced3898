#include <cmath>
#include <numbers>

#include "telltale/core/effects/effect_instance.hpp"
#include "telltale/core/effects/wording.hpp"

namespace telltale {

class HeadingBiasEffect final : public Effect {
 public:
  HeadingBiasEffect()
      : Effect({.name = "heading_bias",
                .title = "a turned compass",
                .equation = "psi_measured = psi + b",
                .source = "Compass misalignment, Fossen 2011, chapter 11",
                .parameters = {{"bias", "rad", 0.052, -0.8, 0.8}},
                .settled_by = "a second GNSS antenna",
                .hook = Hook::kHeading}) {}

  std::string Describe(EffectValues values) const override {
    return "heading reads " + FormatNumber(std::abs(values[0]) * 180.0 / std::numbers::pi, 1) +
           " deg too " + (values[0] < 0.0 ? "low" : "high");
  }

  double HeadingErrorRad(EffectValues values, double) const override { return values[0]; }
};

template const Effect& InstanceOf<HeadingBiasEffect>();

}  // namespace telltale
