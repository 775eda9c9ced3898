#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "telltale/core/diagnosis/residuals/sensitivity.hpp"

namespace telltale {

/// The nominal boat and the errors of its free runs, from nominal recordings,
/// docs/concepts/diagnosis.md (84)..(86). The boat is the model with coefficients and fixed
/// effects recalibrated on those recordings. Its errors scatter by `covariance` from window to
/// window. Coefficients and fixed effects keep the joint covariance `boat_covariance`. Weather is a
/// per-recording random effect of standard deviation `recording_effect_sd`. Shapes: of the rows of
/// FreeRuns::Errors; base in standard errors of the model; effect parameters in typical sizes.
struct NominalBaseline {
  AugmentedModel boat;
  Eigen::VectorXd coefficients;   ///< by which the boat's free parameters differ from the model's
  Eigen::VectorXd fixed_effects;  ///< sizes that the boat has, those too small to simulate included
  Eigen::MatrixXd covariance;
  double kappa = 1.0;                   ///< independent windows per window
  Eigen::MatrixXd boat_covariance;      ///< base, then effect parameters
  Eigen::VectorXd recording_effect_sd;  ///< by effect parameter; zero for all but weather
  std::vector<Sensitivity> days;        ///< of the recordings, about `boat`
  Divergence divergence_of_model;       ///< on the recordings and on those that took no part
  /// ln of what a ResidualMetric leaves of each recording, as a share of what the covariance
  /// expects, and would leave of one that had not taken part in learning.
  std::vector<double> log_reduced_chi_squares;
};

/// What a nominal recording leaves by a baseline that it took no part in.
struct LeftOutDay {
  double squared_gap = 0.0;         ///< G^2, docs/concepts/diagnosis.md (80)
  double reduced_chi_square = 0.0;  ///< by the ResidualMetric of that baseline
};

/// `others` take no part but for this: the boat diverges on no more of their windows, and of the
/// recordings', than the model does. Requires: at least one recording with windows.
NominalBaseline LearnNominalBaseline(const std::vector<FreeRuns>& recordings,
                                     const UncertainModel& model,
                                     const std::vector<EffectParameterRef>& parameter_refs,
                                     std::size_t threads, std::vector<const FreeRuns*> others = {});

/// The baseline that the kept ones of those recordings alone would give, to first order: one
/// Gauss-Newton step from the baseline of all, with the slopes of that. Requires: at least one
/// kept, places within `recordings`; with `others` the same recordings as of all.
NominalBaseline NominalBaselineOf(const std::vector<std::size_t>& kept,
                                  const NominalBaseline& of_all,
                                  const std::vector<FreeRuns>& recordings,
                                  const UncertainModel& model,
                                  const std::vector<EffectParameterRef>& parameter_refs,
                                  std::vector<const FreeRuns*> others = {});

}  // namespace telltale
