#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "telltale/core/diagnosis/residuals/sensitivity.hpp"

namespace telltale {

/// How a nominal boat sails and how its free runs err, from recordings of when all was well,
/// docs/concepts/diagnosis.md (84)..(86). The boat is the model with coefficients and lasting
/// effects recalibrated on those recordings, so that what it always does is no finding. About it
/// errors scatter by `covariance` from window to window; the coefficients and lasting effects are
/// still as uncertain, together, as `boat_covariance` says; and weather is there with another value
/// each day, of standard deviation `recording_effect_sd`. Shapes: of the rows of FreeRuns::Errors;
/// base in standard errors of the model; slots in typical sizes.
struct NominalBaseline {
  AugmentedModel boat;
  Eigen::MatrixXd covariance;
  double kappa = 1.0;                   ///< independent windows per window
  Eigen::MatrixXd boat_covariance;      ///< base, then slots
  Eigen::VectorXd recording_effect_sd;  ///< by slot; zero for what does not pass
  std::vector<Sensitivity> days;        ///< of the recordings, about `boat`
  /// ln of what a ResidualMetric leaves of each recording, as a share of what the covariance
  /// expects, and would leave of one that had not taken part in learning.
  std::vector<double> log_reduced_chi_squares;
};

/// Requires: at least one recording with windows.
NominalBaseline LearnNominalBaseline(const std::vector<FreeRuns>& recordings,
                                     const UncertainModel& model,
                                     const std::vector<EffectParameterRef>& parameter_refs,
                                     std::size_t threads);

}  // namespace telltale
