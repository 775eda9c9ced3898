#pragma once

#include <span>
#include <string>
#include <vector>

#include "telltale/core/identification/identification.hpp"
#include "telltale/core/identification/input_gain.hpp"

namespace telltale {

/// What a command comes to once thrust has settled.
struct CommandGain {
  PropellerCommand delta;
  InputGain gain;
};

/// Seconds until 1 % of an initial condition is left, with the bounds of the time constant.
struct Settling {
  double estimate_s = 0.0;
  double standard_error_s = 0.0;
  Interval interval;
};

/// Requires: the time constant, so the dynamic structure.
Settling SettlingOf(const Identification& identification);

/// Bounds of one axis of a gain, at the level of the model's own.
Interval BoundsOf(const Identification& identification, const InputGain& gain, Equation equation);

/// What a reader of these gains has to know of them.
std::vector<std::string> NotesOn(const Identification& identification,
                                 std::span<const CommandGain> gains);

/// The gains as JSON (proto/gain.proto), in both units.
std::string PrintGainsJson(const Identification& identification,
                           std::span<const CommandGain> gains);

}  // namespace telltale
