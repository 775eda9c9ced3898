#pragma once

#include <cstddef>

#include "telltale/core/diagnosis/hypotheses/diagnosis_problem.hpp"
#include "telltale/core/diagnosis/hypotheses/effect_fit.hpp"

namespace telltale {

/// The effects of `fit` fitted to the windows of `metric`, starting from their values: the
/// deterministic ones first, then the stochastic one, if any, to what those leave.
/// Requires: a stochastic effect, if any, stands last.
EffectFit Refit(const EffectFit& fit, const DiagnosisProblem& problem, const ResidualMetric& metric,
                std::size_t threads);

}  // namespace telltale
