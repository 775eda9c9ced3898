#include "telltale/core/effects/gust_pattern.hpp"

#include <cmath>

#include "telltale/core/base/contract.hpp"

namespace telltale {

GustPattern::GustPattern(const Effect& effect, const Oscillation& oscillation)
    : Effect(effect.Facts()), effect_(effect), oscillation_(oscillation) {
  Require(effect.Facts().hook == Hook::kThrustShare || effect.Facts().hook == Hook::kAcceleration,
          "an effect that acts at an instant");
  Require(oscillation.parameter < effect.Parameters().size(), "a parameter of the effect");
}

double GustPattern::ThrustShare(EffectValues values, Side side, const InstantState& instant) const {
  return effect_.ThrustShare(ValuesAt(values, instant.time_s), side, instant);
}

NuDot GustPattern::AddedAcceleration(EffectValues values, const InstantState& instant) const {
  return effect_.AddedAcceleration(ValuesAt(values, instant.time_s), instant);
}

std::vector<double> GustPattern::ValuesAt(EffectValues values, double time_s) const {
  std::vector<double> now(values.begin(), values.end());
  now[oscillation_.parameter] +=
      oscillation_.deviation *
      std::cos(oscillation_.frequency_rad_s * time_s + oscillation_.phase_rad);
  return now;
}

}  // namespace telltale
