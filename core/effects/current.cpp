#include <cmath>

#include "telltale/core/effects/effect_instance.hpp"
#include "telltale/core/effects/wording.hpp"

namespace telltale {
namespace {

// Tide and eddies change a current by a fifth (one sigma), over minutes: it stays as it is
// throughout a free run.
constexpr double kVariation = 0.2;
constexpr double kDriftTimeS = 120.0;

}  // namespace

class CurrentEffect final : public Effect {
 public:
  CurrentEffect()
      : Effect(
            {.name = "current",
             .title = "a current",
             .equation =
                 "nu_r = nu - R(psi)' V_c in the hull's forces, and nu_dot += (r v_c, -r u_c, 0)",
             .source = "Fossen, Handbook of Marine Craft Hydrodynamics and Motion Control, 2011, "
                       "chapter 8",
             .parameters = {{"current_north", "m/s", 0.2, -2.0, 2.0},
                            {"current_east", "m/s", 0.2, -2.0, 2.0}},
             .settled_by = "a current meter or a log of speed through the water",
             .nominal_variation = NominalVariation::kRecordingEffect,
             .turbulence_intensity = kVariation,
             .drift_time_s = kDriftTimeS,
             .is_weather = true,
             .length_name = "speed",
             .is_north_east = true}) {}

  std::string Describe(EffectValues values) const override {
    return FormatNumber(std::hypot(values[0], values[1]), 2) + " m/s of current " +
           Towards(values[0], values[1]);
  }

  Eigen::Vector2d Current(EffectValues values) const override { return {values[0], values[1]}; }
};

template const Effect& InstanceOf<CurrentEffect>();

}  // namespace telltale
