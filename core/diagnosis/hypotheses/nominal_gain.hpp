#pragma once

#include <map>
#include <span>

#include "telltale/core/diagnosis/hypotheses/diagnosis_problem.hpp"
#include "telltale/core/effects/effect.hpp"

namespace telltale {

/// The evidence, in -2 ln, that each effect gains on nominal recordings, where it does not act: the
/// largest of all references by the score test, scaled to as many observations as the recording
/// has, times kDiagnosis.search.nominal_gain_factor. Zero for a stochastic effect.
std::map<const Effect*, double> NominalGains(const DiagnosisProblem& problem,
                                             std::span<const Effect* const> library);

}  // namespace telltale
