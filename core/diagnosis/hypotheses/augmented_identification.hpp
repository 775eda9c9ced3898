#pragma once

#include "telltale/core/diagnosis/baseline/uncertain_model.hpp"
#include "telltale/core/diagnosis/hypotheses/diagnosis_problem.hpp"
#include "telltale/core/diagnosis/hypotheses/effect_fit.hpp"
#include "telltale/core/effects/augmented_model.hpp"
#include "telltale/core/identification/identification.hpp"

namespace telltale {

/// The nominal boat with the effects of a fit, coefficients identified again on the recording with
/// them in: what their covariance and nominal days leave open follows the data.
AugmentedModel Reidentified(const EffectFit& fit, const DiagnosisProblem& problem,
                            const UncertainModel& model);

/// The same as a model to publish: the old one's coefficients replaced, with the uncertainty that
/// is left, and the effects named.
Identification Augmented(const Identification& old, const AugmentedModel& boat,
                         const EffectFit& fit, const DiagnosisProblem& problem,
                         const UncertainModel& model);

/// The model and its effects, ready to sail.
/// Refuses when: the model lacks an equation, or names an effect that there is not.
Result<AugmentedModel> AugmentedModelOf(const Identification& identification);

}  // namespace telltale
