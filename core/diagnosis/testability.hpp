#pragma once

#include <span>
#include <vector>

#include "telltale/core/diagnosis/diagnosis.hpp"
#include "telltale/core/diagnosis/evidence.hpp"
#include "telltale/core/diagnosis/uncertain_model.hpp"

namespace telltale {

/// What this recording would show of each effect at its typical size, docs/diagnosis.md (92): in
/// sigmas, once the coefficients have absorbed what their uncertainty allows.
std::vector<EffectTestability> TestabilityOf(const Evidence& evidence, const UncertainModel& model,
                                             std::span<const Effect* const> library);

}  // namespace telltale
