#pragma once

#include <cmath>
#include <string>
#include <string_view>

#include "telltale/core/effects/effect.hpp"

namespace telltale::testing {

/// An acceleration that is no effect of the library.
class Unlisted : public Effect {
 public:
  explicit Unlisted(std::string_view name)
      : Effect({.name = name,
                .title = "",
                .equation = "",
                .source = "",
                .parameters = {},
                .settled_by = "",
                .hook = Hook::kAcceleration}) {}
  std::string Describe(EffectValues) const override { return ""; }
};

/// A swell of one frequency and known phase, which the simulator can follow. The library's waves
/// describe only how it scatters the windows.
class Swell : public Unlisted {
 public:
  static constexpr double kFrequency = 2.5;

  explicit Swell(std::string_view name = "swell") : Unlisted(name) {}
  NuDot AddedAcceleration(EffectValues, const InstantState& instant) const override {
    const double phase = kFrequency * instant.time_s;
    return {0.2 * std::cos(phase), 0.2 * std::sin(phase), 0.1 * std::cos(phase + 1.0)};
  }
};

}  // namespace telltale::testing
