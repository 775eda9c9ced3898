#pragma once

#include <vector>

#include <Eigen/Core>

#include "telltale/core/estimation/regression/excitation.hpp"
#include "telltale/core/estimation/regression/regression_problem.hpp"

namespace telltale {

/// The least-squares solution of one equation.
/// Shapes: theta, estimable: one entry per excited column, in the order of Excitation::excited.
/// estimable[j] is false when theta_j is a part of a direction the data do not determine at all; it
/// is then the minimum-norm choice, good for predicting similar motion and for nothing else.
struct EquationEstimate {
  Equation equation = Equation::kUnknown;
  std::vector<std::size_t> columns;
  Eigen::VectorXd theta;
  std::vector<bool> estimable;
  /// basis (p x rank): Phi basis has orthonormal columns, so Cov(theta) = sigma^2 basis basis'.
  Eigen::MatrixXd basis;
  double residual_variance = 0.0;  ///< sigma^2 of y, unbiased under white residuals
  double degrees_of_freedom = 0.0;
};

/// One-step least squares by singular values of the column-scaled triangle; docs/concepts/model.md
/// (14). Assumes: rows whose errors are in y alone. Velocities that are themselves measured break
/// this: the estimate is attenuated, and no covariance of the residuals shows it
/// (docs/concepts/model.md, Limits). Source: the paper, Propositions 1 and 2.
EquationEstimate EstimateOneStep(const Excitation& excitation);

}  // namespace telltale
