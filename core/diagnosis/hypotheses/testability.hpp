#pragma once

#include "telltale/core/diagnosis/diagnosis.hpp"
#include "telltale/core/diagnosis/hypotheses/diagnosis_problem.hpp"
#include "telltale/core/diagnosis/hypotheses/present_weather.hpp"
#include "telltale/core/identification/uncertain_model.hpp"

namespace telltale {

/// Whether this recording would show an effect at its typical size, docs/concepts/diagnosis.md
/// (92). Detectability is in sigmas, once coefficients and the weather have taken up what they may;
/// of several parameters it is the root mean square. An effect is masked where it would be
/// detectable but for them; `masked_by` then names the weather, or the most similar coefficient.
/// Without detectable sizes.
EffectTestability TestabilityOf(const Effect& effect, const DiagnosisProblem& problem,
                                const PresentWeather& weather, const UncertainModel& model);

}  // namespace telltale
