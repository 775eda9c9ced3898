#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "data/prepared_dataset.hpp"
#include "estimation/one_step.hpp"
#include "estimation/regression_problem.hpp"

namespace telltale {

/// The rows of one equation of the first-order dynamic structure, docs/model.md (22):
///   y = body theta_body + T(alpha) theta_propeller + c_s alpha^m + e
/// where T(alpha) are the propeller regressors after the thrusters' lag, followed from the start of each
/// stretch, and c_s alpha^m is what the unknown thrust at the start of stretch s still does m rows later.
/// Only commands pass through the lag, never a measured velocity: noise in velocities, and the memory
/// that smoothing gives them, would otherwise be taken for lag.
/// Shapes: body n x (body regressors), y and nu n; instants[i] is the row of the dataset.
struct LaggedEquation {
  Equation equation = Equation::kUnknown;
  std::span<const Regressor> regressors;
  Eigen::MatrixXd body;
  Eigen::VectorXd y;
  Eigen::VectorXd nu;
  std::vector<std::size_t> instants;
  std::vector<RowRange> clusters;   ///< rows of each segment of the dataset, possibly none
  std::vector<RowRange> stretches;  ///< rows of each stretch, possibly none
};

struct LaggedProblem {
  Parameterization parameterization = Parameterization::kUnknown;
  double sampling_period_s = 0.0;
  std::array<LaggedEquation, 3> equations;
  std::vector<ThrustRegressors> commanded;   ///< of every row of the dataset, before any lag
  std::vector<RowRange> stretches;           ///< of the dataset

  /// One equation's rows for thrusters that reach the commanded thrust within a period (alpha = 0): a
  /// static problem of the same columns, which is what excitation is judged on.
  EquationProblem WithoutLag(Equation equation) const;
};

/// PreparedDataset -> LaggedProblem. Rows k need k-1, k and k+1 in one stretch; the region that decides
/// whether a row enters is that of the command at k-1, which is what acts.
LaggedProblem BuildLagged(const PreparedDataset& dataset, const RegressionOptions& options);

/// One alpha for the boat and one value for each physical coefficient.
struct LaggedEstimate {
  double alpha = 0.0;          ///< exp(-h / time constant), in (0, 1)
  double time_constant_s = 0.0;
  std::array<std::optional<EquationEstimate>, 3> equations;
  /// Stacked rows of the answered equations, segment by segment, each equation divided by the standard
  /// deviation of its residuals, the unknown thrust at the start of each stretch projected out. Columns:
  /// alpha, then the coefficients of each equation.
  Eigen::MatrixXd jacobian;
  Eigen::VectorXd residual;
  std::vector<RowRange> clusters;
};

/// Consistent least squares over the equations that have an excitation: alpha shared, inside (0, 1),
/// each equation weighted by its residual variance. docs/model.md (23).
/// Method: variable projection. For a given alpha everything else is linear and solved for; what is left
/// is a problem in alpha alone, started from the best of a grid of lags and finished by
/// Levenberg-Marquardt (Ceres) with Kaufman's Jacobian.
/// Assumes: as EstimateOneStep, errors in y alone.
/// Source: Golub, Pereyra, "Separable nonlinear least squares: the variable projection method and its
/// applications", Inverse Problems 19 (2003).
LaggedEstimate EstimateLagged(const LaggedProblem& problem,
                              const std::array<std::optional<Excitation>, 3>& excitations);

}  // namespace telltale
