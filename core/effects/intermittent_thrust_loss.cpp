#include <algorithm>
#include <cmath>

#include "telltale/core/effects/effect_instance.hpp"
#include "telltale/core/effects/wording.hpp"

namespace telltale {
namespace {

// Weed is shed, and a propeller draws air, within seconds: about as long as a free run lasts.
constexpr double kSpellS = 5.0;

}  // namespace

class IntermittentThrustLossEffect final : public Effect {
 public:
  IntermittentThrustLossEffect()
      : Effect(
            {.name = "intermittent_thrust_loss",
             .title = "a thruster that loses thrust at times",
             .equation = "T_port -> (1 - e) T_port for e > 0, T_starboard -> (1 + e) T_starboard "
                         "for e < 0, e random, in spells",
             .source = "Ventilation and weed: Carlton, Marine Propellers and Propulsion, 2018, "
                       "chapter 9; Faltinsen, Hydrodynamics of High-Speed Marine Vehicles, 2005, "
                       "chapter 2",
             .parameters = {{"mean_port_loss", "1", 0.12, -0.8, 0.8}},
             .settled_by = "the current drawn by each thruster",
             .hook = Hook::kThrustShare,
             .nominal_variation = NominalVariation::kNone,
             .turbulence_time_s = kSpellS,
             // Of a loss e for a share p of the time, e sqrt(p (1 - p)): of a quarter for a fifth
             // of it, of half for a fifth, and of four fifths for half of it.
             .intermittent_sds = {0.1, 0.2, 0.4}}) {}

  std::string Describe(EffectValues values) const override {
    return (values[0] < 0.0 ? "starboard thruster " : "port thruster ") + Percent(values[0]) +
           " weaker on average, and at times only";
  }

  double ThrustShare(EffectValues values, Side side, const InstantState&) const override {
    const double loss = side == Side::kPort ? values[0] : -values[0];
    return std::max(1.0 - std::max(loss, 0.0), 0.0);
  }
};

template const Effect& InstanceOf<IntermittentThrustLossEffect>();

}  // namespace telltale
