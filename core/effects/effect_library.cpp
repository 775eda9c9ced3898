#include <algorithm>
#include <array>

#include "telltale/core/effects/effect.hpp"

namespace telltale {

// Defined in effect_instance.hpp, which this file leaves out: each effect's file instantiates it.
template <class DerivedEffect>
const Effect& InstanceOf();

// Every effect, in the order of reports. An effect is one line here and one file of its name;
// docs/guides/adding-an-effect.md shows how.
static constexpr std::array kInstances = {
    &InstanceOf<class WindEffect>,
    &InstanceOf<class CurrentEffect>,
    &InstanceOf<class CurrentShearEffect>,
    &InstanceOf<class WavesEffect>,
    &InstanceOf<class BodyBiasEffect>,
    &InstanceOf<class ThrusterDeadZoneEffect>,
    &InstanceOf<class ThrusterLagEffect>,
    &InstanceOf<class ThrusterDelayEffect>,
    &InstanceOf<class ThrusterImbalanceEffect>,
    &InstanceOf<class ThrusterSaturationEffect>,
    &InstanceOf<class OutputSlewEffect>,
    &InstanceOf<class OutputStuckEffect>,
    &InstanceOf<class ThrusterMisalignmentEffect>,
    &InstanceOf<class ThrustGainEffect>,
    &InstanceOf<class ThrustSagEffect>,
    &InstanceOf<class ThrustInflowLossEffect>,
    &InstanceOf<class IntermittentThrustLossEffect>,
    &InstanceOf<class PayloadEffect>,
    &InstanceOf<class TrimSinkageEffect>,
    &InstanceOf<class HullFoulingEffect>,
    &InstanceOf<class CrossflowDragEffect>,
    &InstanceOf<class AddedMassCouplingEffect>,
    &InstanceOf<class HeadingBiasEffect>,
    &InstanceOf<class MagneticDeviationEffect>,
    &InstanceOf<class AntennaLeverArmEffect>,
    &InstanceOf<class GnssLatencyEffect>,
};

std::span<const Effect* const> EffectLibrary() {
  static const auto library = [] {
    std::array<const Effect*, kInstances.size()> effects{};
    std::ranges::transform(kInstances, effects.begin(), [](auto instance) { return &instance(); });
    return effects;
  }();
  return library;
}

const Effect* FindEffect(std::string_view name) {
  const auto library = EffectLibrary();
  const auto found = std::ranges::find(library, name, &Effect::Name);
  return found == library.end() ? nullptr : *found;
}

}  // namespace telltale
