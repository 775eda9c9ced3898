#pragma once

#include <cmath>
#include <numbers>

namespace telltale {

/// The share of a Gauss-Markov process' variance that varies by k half turns over a span of
/// time: its correlation exp(-t / T) is, over a span H, the sum over k of c_k cos(k pi t / H),
/// with c_k = 2 T/H (1 - (-1)^k exp(-H/T)) / (1 + (k pi T/H)^2) and half of that for k = 0. Each
/// term is a cosine and a sine of independent random sizes; docs/concepts/diagnosis.md (97).
/// `lasting` is T/H.
inline double GaussMarkovShare(int half_turns, double lasting) {
  const double kept = std::exp(-1.0 / lasting);
  const double last = half_turns % 2 == 0 ? kept : -kept;
  const double turns = half_turns * std::numbers::pi * lasting;
  return (half_turns == 0 ? 1.0 : 2.0) * lasting * (1.0 - last) / (1.0 + turns * turns);
}

}  // namespace telltale
