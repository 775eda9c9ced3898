#pragma once

#include "telltale/core/diagnosis/hypotheses/effect_posterior.hpp"

namespace telltale {

/// The minimum of the posterior's cost that Levenberg-Marquardt reaches from `point`.
/// Damping multiplies the diagonal of the information. Steps stay within the bounds of the
/// parameters. The search ends when a step gains less than kDiagnosis.effect_fit.converged_gain.
PosteriorPoint MinimiseCost(const EffectPosterior& posterior, PosteriorPoint point);

}  // namespace telltale
