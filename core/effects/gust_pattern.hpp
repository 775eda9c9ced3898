#pragma once

#include <cstddef>

#include "telltale/core/effects/effect.hpp"

namespace telltale {

/// An effect one parameter of which oscillates about its value: by `deviation` times the cosine of
/// the recording's time. It stands in for that effect, with its values, where gusts are linearised.
/// Requires: an effect of Hook::kThrustShare or Hook::kAcceleration, which outlives this one.
class GustPattern final : public Effect {
 public:
  struct Oscillation {
    std::size_t parameter = 0;
    double deviation = 0.0;        ///< in the parameter's unit
    double frequency_rad_s = 0.0;  ///< of the oscillation; 0: the deviation all the time
    double phase_rad = 0.0;        ///< at the recording's start
  };

  GustPattern(const Effect& effect, const Oscillation& oscillation);

  std::string Describe(EffectValues values) const override { return effect_.Describe(values); }
  double ThrustShare(EffectValues values, Side side, const InstantState& instant) const override;
  NuDot AddedAcceleration(EffectValues values, const InstantState& instant) const override;

 private:
  std::vector<double> ValuesAt(EffectValues values, double time_s) const;

  const Effect& effect_;
  Oscillation oscillation_;
};

}  // namespace telltale
