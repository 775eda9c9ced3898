#pragma once

#include "telltale/core/diagnosis/hypotheses/cross_validation.hpp"
#include "telltale/core/diagnosis/hypotheses/diagnosis_problem.hpp"

namespace telltale {

/// What a ResidualMetric has against a recording, as shares of what a nominal one is expected to
/// leave, about one: without an explanation, with the likeliest, fitted to other windows than it is
/// judged on, and of the references.
struct LackOfFit {
  double before = 1.0;
  double after = 1.0;
  double nominal = 1.0;
  /// ln of how much less than `after` is left of each fold once what the effects' slopes make of
  /// the other fold's remainder is taken off. Above zero where the same is wrong everywhere, so
  /// that something else is at work; zero or less where a rough day has made windows err.
  double predictable = 0.0;
};

/// Of the likeliest explanation, docs/concepts/diagnosis.md (98).
LackOfFit AssessLackOfFit(const EffectFit& best, const CrossValidatedErrors& cross_validated,
                          const DiagnosisProblem& problem);

}  // namespace telltale
