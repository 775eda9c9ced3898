#include <cmath>
#include <numbers>

#include "telltale/core/effects/effect_instance.hpp"
#include "telltale/core/effects/wording.hpp"

namespace telltale {

class WavesEffect final : public Effect {
 public:
  WavesEffect()
      : Effect(
            {.name = "waves",
             .title = "waves",
             .equation =
                 "nu_dot += (a_x, a_y, a_n) cos(w_e t + phase), phase random from window to window",
             .source = "Fossen 2011, chapter 8: first-order wave-induced forces about the "
                       "encounter frequency",
             .parameters = {{"surge_amplitude", "m/s^2", 0.2, 0.0, 3.0},
                            {"sway_amplitude", "m/s^2", 0.2, 0.0, 3.0},
                            {"yaw_amplitude", "rad/s^2", 0.2, 0.0, 3.0},
                            {"encounter_frequency", "rad/s", 1.0, 0.8, 6.0, true, 2.5}},
             .settled_by = "an inertial sensor",
             .nominal_variation = NominalVariation::kRecordingEffect,
             .is_weather = true,
             .length_name = "amplitude"}) {}

  std::string Describe(EffectValues values) const override {
    const double amplitude = std::hypot(values[0], values[1]);
    return "waves of " + FormatNumber(amplitude, 2) + " m/s^2 met every " +
           FormatNumber(2.0 * std::numbers::pi / values[3], 1) + " s";
  }

  std::optional<NarrowBandExcitation> StochasticExcitation(EffectValues values) const override {
    return NarrowBandExcitation{{values[0], values[1], values[2]}, values[3]};
  }
};

template const Effect& InstanceOf<WavesEffect>();

}  // namespace telltale
