#pragma once

#include <vector>

#include <Eigen/Core>

#include "telltale/core/diagnosis/baseline/residual_metric.hpp"
#include "telltale/core/diagnosis/residuals/sensitivity.hpp"
#include "telltale/core/effects/effect.hpp"

namespace telltale {

/// Where the fit of one effect starts, given the errors that are left: at the minimum of the
/// linearised cost, and for an effect with one free parameter also at both signs of its typical
/// size, where its range has them, and last at kDiagnosis.effect_fit.beyond_threshold of it where
/// it hides below a threshold. `parameter_refs` name the columns of the sensitivity.
std::vector<Eigen::VectorXd> StartsOf(const Effect& effect, const ResidualMetric& metric,
                                      const Eigen::MatrixXd& errors, const Sensitivity& recording,
                                      const std::vector<EffectParameterRef>& parameter_refs);

/// Whether the typical size of an effect of one parameter and one sign hardly shows on this
/// recording. A larger one may show all the same: commands are cut off where they reach so far. A
/// score test says nothing of it.
bool HidesBelowThreshold(const Effect& effect, const ResidualMetric& metric,
                         const Sensitivity& recording,
                         const std::vector<EffectParameterRef>& parameter_refs);

/// -2 ln of the likelihood that the linearised minimum promises over that of no effect; zero at
/// the most.
double ScoreTest(const Effect& effect, const ResidualMetric& metric, const Eigen::MatrixXd& errors,
                 const Sensitivity& recording,
                 const std::vector<EffectParameterRef>& parameter_refs);

}  // namespace telltale
