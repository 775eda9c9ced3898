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
///   step_now - alpha step_before = (now - alpha before) theta_body + (1 - alpha) thrust theta_propeller + e
/// Shapes: now, before n x (body regressors) at instants k and k-1; thrust n x (propeller regressors) of
/// the command at k-1; step_now = (nu(k+1) - nu(k)) / h and step_before = (nu(k) - nu(k-1)) / h.
struct LaggedEquation {
  Equation equation = Equation::kUnknown;
  std::span<const Regressor> regressors;
  Eigen::MatrixXd now;
  Eigen::MatrixXd before;
  Eigen::MatrixXd thrust;
  Eigen::VectorXd step_now;
  Eigen::VectorXd step_before;
  Eigen::VectorXd nu;  ///< the equation's velocity at k
  std::vector<RowRange> clusters;  ///< one per segment of the dataset, possibly empty

  /// The rows for thrusters that follow at once (alpha = 0): a static problem of the same columns, which
  /// is what excitation is judged on.
  EquationProblem WithoutLag() const;
};

struct LaggedProblem {
  Parameterization parameterization = Parameterization::kUnknown;
  double sampling_period_s = 0.0;
  std::array<LaggedEquation, 3> equations;
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
  /// deviation of its residuals. Columns: alpha, then the coefficients of each equation.
  Eigen::MatrixXd jacobian;
  Eigen::VectorXd residual;
  std::vector<RowRange> clusters;
};

/// Consistent least squares over the equations that have an excitation: alpha shared, inside (0, 1),
/// each equation weighted by its residual variance. docs/model.md (23).
/// Method: every equation is reduced to a triangle once; alpha starts at the best of a grid, for each value
/// of which the rest is linear, and Levenberg-Marquardt (Ceres) finishes jointly.
/// Assumes: as EstimateOneStep, errors in the left-hand side alone.
LaggedEstimate EstimateLagged(const LaggedProblem& problem,
                              const std::array<std::optional<Excitation>, 3>& excitations);

}  // namespace telltale
