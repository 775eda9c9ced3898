#pragma once

#include <array>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "telltale/core/estimation/regression/lagged_problem.hpp"
#include "telltale/core/estimation/regression/one_step.hpp"

namespace telltale {

/// One lag for the boat and one value for each physical coefficient.
struct LaggedEstimate {
  double time_constant_s = 0.0;     ///< [0.001, 10000] sampling periods
  bool lag_at_lower_bound = false;  ///< then the data bound the time constant only from above
  std::array<std::optional<EquationEstimate>, 3> equations;
  /// Stacked rows of the answered equations, slice by slice. Each equation is divided by the
  /// standard deviation of its residuals, and the unknown thrust at the start of each segment is
  /// projected out. Columns: the time constant, then the coefficients of each equation.
  Eigen::MatrixXd jacobian;
  Eigen::VectorXd residual;
  std::vector<RowRange> clusters;
  std::vector<std::size_t> instants;  ///< the dataset's row of each row
};

/// Consistent least squares over the equations that have an excitation (of problem.at_once), with
/// one lag for all, alpha = exp(-h / tau) inside (0, 1), and each equation weighted by its residual
/// variance. docs/concepts/model.md (23). Method: variable projection. For a given lag everything
/// else is linear and solved for. The remaining problem in the lag alone starts from the best of a
/// grid and is solved by Levenberg-Marquardt (Ceres) with Kaufman's Jacobian.
/// Assumes: as EstimateOneStep, errors in y alone.
/// Requires: at least one equation with an excitation.
/// Source: Golub, Pereyra, "Separable nonlinear least squares: the variable projection method and
/// its applications", Inverse Problems 19 (2003).
LaggedEstimate EstimateLagged(const LaggedProblem& problem,
                              const std::array<std::optional<Excitation>, 3>& excitations);

/// The deviance of a time constant: -2 log likelihood less its value at the estimate, with
/// everything else fitted again: sum over the equations of n log(s^2 / s^2 at the estimate).
/// Assumes: white residuals. docs/concepts/model.md (72).
double LagDeviance(const LaggedProblem& problem,
                   const std::array<std::optional<Excitation>, 3>& excitations,
                   const LaggedEstimate& estimate, double time_constant_s);

/// The time constants that EstimateLagged() seeks among: 0.001 to 10000 sampling periods.
struct LagLimits {
  double shortest_s = 0.0;
  double longest_s = 0.0;
};
LagLimits LimitsOfLag(const LaggedProblem& problem);

}  // namespace telltale
