#pragma once

#include <cstddef>

#include <Eigen/Core>

#include "telltale/core/diagnosis/hypotheses/diagnosis_problem.hpp"
#include "telltale/core/diagnosis/hypotheses/effect_fit.hpp"

namespace telltale {

/// Fits an effect that shakes the boat at random: free runs cannot follow it, but their errors
/// scatter more, in the pattern that accelerations of one frequency leave.
/// Model: a window's errors are N(0, V + sum over axes of a_j^2 / 2 (c_j c_j' + s_j s_j')), with
/// c_j and s_j the mean response to cos and sin of the frequency; docs/concepts/diagnosis.md (90).
/// `errors` are what is left to explain, by whatever else acts. The evidence counts as far as a
/// frequency within the range explains more than the ends of it, throughout the recording.
/// Requires: an effect that shakes.
EffectFit FitStochasticExcitation(const Effect& effect, const DiagnosisProblem& problem,
                                  const ResidualMetric& metric, const Eigen::MatrixXd& errors,
                                  std::size_t threads);

/// Effects that move free runs and one that shakes beside them, which explains what they leave.
EffectFit WithStochasticEffect(const EffectFit& moving, const EffectFit& stochastic);

/// Fits the effects of `fit` anew, from where they are, to the windows that a judge sees.
EffectFit Refit(const EffectFit& fit, const DiagnosisProblem& problem, const ResidualMetric& metric,
                std::size_t threads);

/// By how much it raises the mean square of each row's error.
Eigen::VectorXd StochasticMeanSquares(const EffectFit& fit, const FreeRuns& runs,
                                      const AugmentedModel& boat);

/// In sigmas, what windows of a nominal boat would show of the effect's typical size.
double StochasticDetectability(const Effect& effect, const DiagnosisProblem& problem);

}  // namespace telltale
