#pragma once

#include <optional>

#include "telltale/core/diagnosis/hypotheses/diagnosis_problem.hpp"
#include "telltale/core/diagnosis/hypotheses/effect_fit.hpp"
#include "telltale/core/diagnosis/report/diagnosis.hpp"

namespace telltale {

/// When an explanation began to act, if the recording's early windows are better without it.
/// Method: -2 ln likelihood with the explanation from a window on, against all along; the interval
/// holds the beginnings within 3.84 of the best (chi-squared, 95 %). docs/concepts/diagnosis.md
/// (95).
std::optional<Onset> OnsetOf(const EffectFit& fit, const DiagnosisProblem& problem);

}  // namespace telltale
