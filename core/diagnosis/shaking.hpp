#pragma once

#include <cstddef>

#include <Eigen/Core>

#include "diagnosis/effect_fit.hpp"

namespace telltale {

/// Fits an effect that shakes the boat at random: free runs cannot follow it, but their errors
/// scatter more, in the pattern that accelerations of one frequency leave.
/// Model: a window's errors are N(0, V + sum over axes of a_j^2 / 2 (c_j c_j' + s_j s_j')), with
/// c_j and s_j the mean response to cos and sin of the frequency; docs/diagnosis.md (90). The score
/// is against health, as in FitEffects, but also no better than against scatter that grew alike in
/// every direction, which is nobody's effect. Requires: an effect whose parameters are three
/// amplitudes and a frequency.
EffectFit FitShaking(const Effect& effect, const FreeRuns& runs, const Healthy& healthy,
                     const Judge& judge, const Eigen::MatrixXd& errors, std::size_t threads);

/// By how much it raises the mean square of each row's error.
Eigen::VectorXd ShakenSquares(const EffectFit& fit, const FreeRuns& runs,
                              const AugmentedModel& boat);

/// In sigmas, what windows of a healthy boat would show of the effect's typical size.
double ShakingDetectability(const Effect& effect, const FreeRuns& runs, const AugmentedModel& boat,
                            const Judge& judge);

}  // namespace telltale
