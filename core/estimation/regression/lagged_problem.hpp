#pragma once

#include <vector>

#include "telltale/core/data/prepared_dataset.hpp"
#include "telltale/core/estimation/regression/regression_problem.hpp"
#include "telltale/core/vessel/thruster_response.hpp"

namespace telltale {

/// The regressions of the first-order dynamic structure, docs/concepts/model.md (22):
///   y(k) = body(k) theta_body + Tbar(k) theta_propeller + c_s alpha^m + e(k)
/// Tbar(k) are the propeller regressors after the thrusters' lag, averaged over [t_k, t_k + h) and
/// followed from the start of segment s. c_s alpha^m is the effect of the unknown thrust at that
/// start, m rows later. Without lag (alpha to zero) these are exactly the regressions of the static
/// structure. Only commands pass through the lag, never a measured velocity: the noise and the
/// smoothing of velocities would bias the lag.
struct LaggedProblem {
  RegressionProblem at_once;                ///< the same rows for thrusters without lag
  std::vector<ThrustRegressors> commanded;  ///< of every row of the dataset, before any lag
  std::vector<RowRange> segments;           ///< of the dataset
};

/// PreparedDataset -> LaggedProblem, rows as in BuildRegression.
LaggedProblem BuildLagged(const PreparedDataset& dataset, const RegressionOptions& options);

/// The propeller regressors averaged over each row's interval, and their derivatives by the lag in
/// sampling periods.
struct LaggedThrust {
  std::vector<ThrustRegressors> mean;
  std::vector<ThrustRegressors> slope;
};

/// Each segment begins with its commanded thrust.
LaggedThrust LagThrust(const LaggedProblem& problem, const LagPerPeriod& lag);

}  // namespace telltale
