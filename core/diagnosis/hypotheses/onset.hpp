#pragma once

#include <optional>

#include "telltale/core/diagnosis/diagnosis.hpp"
#include "telltale/core/diagnosis/hypotheses/diagnosis_problem.hpp"
#include "telltale/core/diagnosis/hypotheses/effect_fit.hpp"

namespace telltale {

/// When a hypothesis began to act. Method: -2 ln likelihood with the hypothesis from one window on,
/// against all along; the interval holds the onsets within 3.84 of the best (chi-squared, 95 %).
/// docs/concepts/diagnosis.md (95). None where the recording is too short, or where the best onset
/// gains too little over none.
std::optional<Onset> OnsetOf(const EffectFit& fit, const DiagnosisProblem& problem);

}  // namespace telltale
