#pragma once

#include <span>
#include <vector>

#include "telltale/core/diagnosis/baseline/uncertain_model.hpp"
#include "telltale/core/diagnosis/hypotheses/diagnosis_problem.hpp"
#include "telltale/core/diagnosis/report/diagnosis.hpp"

namespace telltale {

/// What this recording would show of each effect at its typical size, docs/concepts/diagnosis.md
/// (92): in sigmas, once the coefficients have absorbed what their uncertainty allows.
std::vector<EffectTestability> TestabilityOf(const DiagnosisProblem& problem,
                                             const UncertainModel& model,
                                             std::span<const Effect* const> library);

}  // namespace telltale
