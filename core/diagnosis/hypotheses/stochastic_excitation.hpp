#pragma once

#include <cstddef>

#include <Eigen/Core>

#include "telltale/core/diagnosis/hypotheses/diagnosis_problem.hpp"
#include "telltale/core/diagnosis/hypotheses/effect_fit.hpp"

namespace telltale {

/// Fits an effect whose accelerations are random: free runs cannot predict it, but their errors
/// scatter more, in the pattern that accelerations of one frequency leave.
/// Model: a window's errors are N(0, V + sum over axes of a_j^2 / 2 (c_j c_j' + s_j s_j')), with
/// c_j and s_j the mean response to cos and sin of the frequency; docs/concepts/diagnosis.md (90).
/// `errors` are those that other effects leave, rows x windows. Evidence is what a frequency within
/// the range explains beyond the ends of the range, in three of four blocks of the recording.
/// Requires: a stochastic effect.
EffectFit FitStochasticExcitation(const Effect& effect, const DiagnosisProblem& problem,
                                  const ResidualMetric& metric, const Eigen::MatrixXd& errors,
                                  std::size_t threads);

/// Deterministic effects together with the stochastic effect that was fitted to what they leave.
EffectFit WithStochasticEffect(const EffectFit& deterministic, const EffectFit& stochastic);

/// By how much the stochastic effects of a fit, and the gusts that it allows for, raise the mean
/// square of each row's error.
Eigen::VectorXd StochasticMeanSquares(const EffectFit& fit, const FreeRuns& runs,
                                      const AugmentedModel& boat);

/// In sigmas, what the effect's typical size adds to the scatter of a nominal boat's windows.
double StochasticDetectability(const Effect& effect, const DiagnosisProblem& problem);

}  // namespace telltale
