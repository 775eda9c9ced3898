#pragma once

#include "telltale/core/diagnosis/hypotheses/diagnosis_problem.hpp"
#include "telltale/core/diagnosis/hypotheses/effect_fit.hpp"

namespace telltale {

/// The effects of `fit` fitted to the windows of `metric`, starting from their values.
/// Requires: a stochastic effect, if any, stands last.
EffectFit Refit(const EffectFit& fit, const DiagnosisProblem& problem,
                const ResidualMetric& metric);

}  // namespace telltale
