#pragma once

#include <array>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "telltale/core/data/prepared_dataset.hpp"
#include "telltale/core/estimation/regression/one_step.hpp"
#include "telltale/core/estimation/regression/regression_problem.hpp"

namespace telltale {

/// The regressions of the first-order dynamic structure, docs/concepts/model.md (22):
///   y(k) = body(k) theta_body + Tbar(k) theta_propeller + c_s alpha^m + e(k)
/// where Tbar(k) are the propeller regressors after the thrusters' lag, averaged over [t_k, t_k +
/// h) and followed from the start of segment s, and c_s alpha^m is what the unknown thrust at that
/// start still does m rows later. Without lag (alpha to zero) these are exactly the regressions of
/// the static structure. Only commands pass through the lag, never a measured velocity: noise in
/// velocities, and the memory that smoothing gives them, would otherwise be taken for lag.
struct LaggedProblem {
  RegressionProblem at_once;                ///< the same rows for thrusters without lag
  std::vector<ThrustRegressors> commanded;  ///< of every row of the dataset, before any lag
  std::vector<RowRange> segments;           ///< of the dataset
};

/// PreparedDataset -> LaggedProblem, rows as in BuildRegression.
LaggedProblem BuildLagged(const PreparedDataset& dataset, const RegressionOptions& options);

/// One lag for the boat and one value for each physical coefficient.
struct LaggedEstimate {
  double time_constant_s = 0.0;  ///< [0.001, 10000] sampling periods
  bool lag_at_lower_bound =
      false;  ///< it lies at the lower end: the data bound it from above alone
  std::array<std::optional<EquationEstimate>, 3> equations;
  /// Stacked rows of the answered equations, slice by slice, each equation divided by the
  /// standard deviation of its residuals, the unknown thrust at the start of each segment projected
  /// out. Columns: the time constant, then the coefficients of each equation.
  Eigen::MatrixXd jacobian;
  Eigen::VectorXd residual;
  std::vector<RowRange> clusters;
  std::vector<std::size_t> instants;  ///< the dataset's row of each row
};

/// Consistent least squares over the equations that have an excitation (of problem.at_once): the
/// lag shared, alpha = exp(-h / tau) inside (0, 1), each equation weighted by its residual
/// variance. docs/concepts/model.md (23). Method: variable projection. For a given lag everything
/// else is linear and solved for; what is left is a problem in the lag alone, started from the best
/// of a grid of lags and finished by Levenberg-Marquardt (Ceres) with Kaufman's Jacobian. Assumes:
/// as EstimateOneStep, errors in y alone. Source: Golub, Pereyra, "Separable nonlinear least
/// squares: the variable projection method and its applications", Inverse Problems 19 (2003).
LaggedEstimate EstimateLagged(const LaggedProblem& problem,
                              const std::array<std::optional<Excitation>, 3>& excitations);

/// Twice the logarithm of how much less likely another time constant makes the data than the
/// estimated one, everything else fitted anew: sum over the equations of n log(s^2 / s^2 at the
/// estimate). Residuals taken as white. docs/concepts/model.md (72).
double LagDeviance(const LaggedProblem& problem,
                   const std::array<std::optional<Excitation>, 3>& excitations,
                   const LaggedEstimate& estimate, double time_constant_s);

/// The time constants that EstimateLagged() seeks among.
struct LagLimits {
  double shortest_s = 0.0;
  double longest_s = 0.0;
};
LagLimits LimitsOfLag(const LaggedProblem& problem);

}  // namespace telltale
