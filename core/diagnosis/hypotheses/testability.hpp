#pragma once

#include <span>
#include <vector>

#include "telltale/core/diagnosis/diagnosis.hpp"
#include "telltale/core/diagnosis/hypotheses/diagnosis_problem.hpp"
#include "telltale/core/identification/uncertain_model.hpp"

namespace telltale {

/// Whether this recording would show each effect at its typical size, docs/concepts/diagnosis.md
/// (92). Detectability is in sigmas, once coefficients have taken up what their uncertainty allows;
/// of several parameters it is the root mean square. An effect is masked where it would be
/// detectable but for the coefficients; `masked_by` then names the most similar one. One entry per
/// effect of the library, in its order, without detectable sizes.
std::vector<EffectTestability> TestabilityOf(const DiagnosisProblem& problem,
                                             const UncertainModel& model,
                                             std::span<const Effect* const> library);

}  // namespace telltale
