#pragma once

#include <cstddef>
#include <map>
#include <span>
#include <vector>

#include "telltale/core/diagnosis/baseline/uncertain_model.hpp"
#include "telltale/core/diagnosis/hypotheses/diagnosis_problem.hpp"
#include "telltale/core/diagnosis/report/diagnosis.hpp"

namespace telltale {

/// Whether this recording would show each effect at its typical size, docs/concepts/diagnosis.md
/// (92). Detectability is in sigmas, once coefficients have taken up what their uncertainty allows;
/// of several parameters it is the root mean square. An effect is masked where it would be
/// detectable but for the coefficients; `masked_by` then names the most similar one. One entry per
/// effect of the library, in its order, with what DetectableSizesOf says of it. `nominal_gains`:
/// NominalGains of the library.
std::vector<EffectTestability> TestabilityOf(const DiagnosisProblem& problem,
                                             const UncertainModel& model,
                                             std::span<const Effect* const> library,
                                             const std::map<const Effect*, double>& nominal_gains,
                                             std::size_t threads);

}  // namespace telltale
