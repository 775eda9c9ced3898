#pragma once

#include "telltale/core/diagnosis/evidence.hpp"
#include "telltale/core/diagnosis/held_out.hpp"

namespace telltale {

/// What a Judge has against a recording, as shares of what a healthy one is expected to leave,
/// about one: without an explanation, with the likeliest, fitted to other windows than it is judged
/// on, and of the references.
struct Remainder {
  double before = 1.0;
  double after = 1.0;
  double healthy = 1.0;
  /// ln of how much less than `after` is left of each fold once what the effects' slopes make of
  /// the other fold's remainder is taken off. Above zero where the same is wrong everywhere, so
  /// that something else is at work; zero or less where a rough day has made windows err.
  double learnable = 0.0;
};

/// Of the likeliest explanation, docs/diagnosis.md (98).
Remainder RemainderOf(const EffectFit& best, const HeldOutErrors& held, const Evidence& evidence);

}  // namespace telltale
