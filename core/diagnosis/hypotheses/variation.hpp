#pragma once

#include <vector>

#include <Eigen/Core>

#include "telltale/core/diagnosis/baseline/residual_metric.hpp"
#include "telltale/core/diagnosis/hypotheses/effect_posterior.hpp"
#include "telltale/core/effects/augmented_model.hpp"

namespace telltale {

/// The values of an effect that are not those of shape parameters.
std::vector<double> SizesOf(const ModelledEffect& modelled);

/// The middle one of the scatters that an intermittent effect may have.
double MiddleScatterOf(const Effect& intermittent);

/// What one standard deviation of gusts, drifts and spells does to the errors: of each size that
/// gusts one column for each course of a gust through a window, of each that drifts one;
/// docs/concepts/diagnosis.md (97). `intermittent_sd` is the scatter of an intermittent effect,
/// `errors` are those with the effects, in windows of window_s.
ErrorVariation VariationOf(const std::vector<ModelledEffect>& effects, double intermittent_sd,
                           const Eigen::MatrixXd& errors, const ErrorModel& error_model,
                           double window_s);

/// By how much the scatter from window to window that spells stand for falls short, in -2 ln of the
/// likelihood of so little: n (s - 1 - ln s) where the realised variance s, over that of the
/// spells, is below one. `errors` are those that a fit leaves.
double ScatterDeficit(const ErrorVariation& variation, const Eigen::MatrixXd& errors,
                      const ResidualMetric& metric);

}  // namespace telltale
