#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "telltale/core/estimation/regression/lagged_problem.hpp"

namespace telltale {

/// One equation at one lag, with its unknown initial thrusts projected out: y = phi theta + e.
/// Shapes: phi n x p; slope n x q, the derivatives of its propeller columns by the lag in sampling
/// periods; y n.
struct EquationAtLag {
  Eigen::MatrixXd phi;
  Eigen::MatrixXd slope;
  Eigen::VectorXd y;
  double directions_out = 0.0;  ///< initial thrusts projected out
};

/// `excited`: the columns to take, ascending.
EquationAtLag ProjectAt(const LaggedProblem& problem, const EquationProblem& equation,
                        const std::vector<std::size_t>& excited, const LaggedThrust& thrust,
                        const LagPerPeriod& lag);

/// The least-squares solution of one equation at one lag. The rows of residual and derivative are
/// rotated so that only p + q + 1 remain. The rotation preserves lengths and angles of the residual
/// and of its Kaufman derivative, which are all that a Gauss-Newton step depends on.
struct SolutionAtLag {
  Eigen::VectorXd theta;
  Eigen::VectorXd residual;    ///< rotated
  Eigen::VectorXd derivative;  ///< of the residual by the lag, rotated alike
  double variance = 0.0;
  double degrees_of_freedom = 0.0;
};

/// Source: Kaufman, "A variable projection method for solving separable nonlinear least squares
/// problems", BIT 15 (1975).
SolutionAtLag SolveAt(const EquationAtLag& at);

}  // namespace telltale
