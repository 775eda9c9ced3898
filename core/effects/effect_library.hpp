#pragma once

#include "telltale/core/effects/effect.hpp"

// Every effect of the library, a line each; each stands in a file of its name. Adding one is shown
// in docs/guides/adding-an-effect.md.
#define TELLTALE_EFFECTS(EFFECT) \
  EFFECT(Wind)                   \
  EFFECT(Current)                \
  EFFECT(Waves)                  \
  EFFECT(BodyBias)               \
  EFFECT(ThrusterDeadZone)       \
  EFFECT(ThrusterLag)            \
  EFFECT(ThrusterDelay)          \
  EFFECT(ThrusterImbalance)      \
  EFFECT(ThrusterSaturation)     \
  EFFECT(ThrusterMisalignment)   \
  EFFECT(ThrustGain)             \
  EFFECT(ThrustSag)              \
  EFFECT(ThrustInflowLoss)       \
  EFFECT(Payload)                \
  EFFECT(HullFouling)            \
  EFFECT(CrossflowDrag)          \
  EFFECT(AddedMassCoupling)      \
  EFFECT(HeadingBias)            \
  EFFECT(AntennaLeverArm)        \
  EFFECT(GnssLatency)

namespace telltale {

#define TELLTALE_DECLARE(Name) const Effect& Name();
TELLTALE_EFFECTS(TELLTALE_DECLARE)
#undef TELLTALE_DECLARE

}  // namespace telltale
