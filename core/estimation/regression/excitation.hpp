#pragma once

#include <array>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "telltale/core/base/result.hpp"
#include "telltale/core/estimation/regression/near_dependency.hpp"
#include "telltale/core/estimation/regression/regression_problem.hpp"
#include "telltale/core/estimation/regression/triangular_factor.hpp"

namespace telltale {

/// The excitation that an equation needs before it is estimated. The defaults suit boats of 0.5 to
/// 5 m. An operator can read each amplitude off a plot.
struct ExcitationLimits {
  double rows_per_coefficient = 10.0;   ///< [2, 1000]
  double surge_speed_spread_mps = 0.1;  ///< standard deviation of u, [0, 10]
  double yaw_rate_spread_radps = 0.05;  ///< standard deviation of r, [0, 3]
  double command_spread = 0.03;  ///< of the mean (surge) or the difference (sway, yaw), [0, 1]
  std::size_t fewest_active_rows = 10;       ///< rows with a thrust term at work, [1, 10000]
  double collinear_condition_index = 100.0;  ///< Belsley's index of column-scaled Phi, [10, 1e6]

  /// The first field out of its range, as a refusal naming field, value and range.
  std::optional<Refusal> Validate() const;
};

/// The excitation of one equation: which columns the data move, and how far they separate them.
struct Excitation {
  Equation equation = Equation::kUnknown;
  std::vector<std::size_t> excited;  ///< columns that the data move; others stay out of the fit
  Eigen::VectorXd column_norms;      ///< of the excited columns
  TriangularFactor factor;           ///< of the excited columns, scaled to unit norm
  Eigen::VectorXd singular_values;   ///< of that scaled triangle, descending
  Eigen::MatrixXd left_singular_vectors;  ///< of that triangle, columns in the same order
  Eigen::MatrixXd right_singular_vectors;
  Eigen::Index rank = 0;
  std::vector<CollinearGroup> collinear;
};

/// Decides whether these rows can answer this equation. Columns are scaled to unit norm first, so
/// the result does not depend on units.
/// Refuses when: rows are too few, or the motion or the command hardly varies.
/// Source: Belsley, Kuh, Welsch, "Regression Diagnostics", 1980, chapter 3 (condition indices and
/// variance-decomposition proportions).
Result<Excitation> Assess(const EquationProblem& problem, const ExcitationLimits& limits);

/// The same for surge, sway and yaw. Sway and yaw have the same regressors; where they have the
/// same rows, these are decomposed once.
std::array<Result<Excitation>, 3> Assess(const std::array<EquationProblem, 3>& problems,
                                         const ExcitationLimits& limits);

/// A refusal that tells an operator which coefficients are collinear and what to record.
Refusal Explain(const CollinearGroup& group, const EquationProblem& problem);

}  // namespace telltale
