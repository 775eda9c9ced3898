#pragma once

#include "telltale/core/diagnosis/hypotheses/diagnosis_problem.hpp"
#include "telltale/core/diagnosis/hypotheses/effect_fit.hpp"
#include "telltale/core/effects/augmented_model.hpp"
#include "telltale/core/identification/identification.hpp"
#include "telltale/core/identification/uncertain_model.hpp"

namespace telltale {

/// The nominal boat with the effects of a fit. Its coefficients are estimated again on the
/// recording with those effects, by ResidualMetric::Recalibrate: within the covariance that the
/// references leave, they follow the data.
AugmentedModel Reidentified(const EffectFit& fit, const DiagnosisProblem& problem,
                            const UncertainModel& model);

/// `old` with the coefficients of `boat`, their posterior covariance and intervals, and with the
/// effects of `boat`. Coefficients that are not free keep their standard errors. Simulation
/// parameters are removed, since they belong to the old estimates.
Identification Augmented(const Identification& old, const AugmentedModel& boat,
                         const EffectFit& fit, const DiagnosisProblem& problem,
                         const UncertainModel& model);

/// The model of an identification together with its effects, for simulation.
/// Refuses when: the model lacks an equation, or names an effect that the library lacks.
Result<AugmentedModel> AugmentedModelOf(const Identification& identification);

}  // namespace telltale
