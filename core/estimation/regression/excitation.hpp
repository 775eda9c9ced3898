#pragma once

#include <array>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "telltale/core/base/result.hpp"
#include "telltale/core/estimation/regression/regression_problem.hpp"
#include "telltale/core/estimation/regression/triangular_factor.hpp"

namespace telltale {

/// A coefficient belongs to an undetermined direction when it makes up more than this of it.
constexpr double kUndeterminedShare = 1e-6;

/// What the data must show before an equation is answered at all. The defaults suit boats of 0.5 to
/// 5 m; all of them are amplitudes an operator can read off a plot.
struct ExcitationLimits {
  double rows_per_coefficient = 10.0;   ///< [2, 1000]
  double surge_speed_spread_mps = 0.1;  ///< standard deviation of u, [0, 10]
  double yaw_rate_spread_radps = 0.05;  ///< standard deviation of r, [0, 3]
  double command_spread = 0.03;  ///< of the mean (surge) or the difference (sway, yaw), [0, 1]
  std::size_t fewest_active_rows = 10;       ///< rows in which a thrust term is at work, [1, 10000]
  double collinear_condition_index = 100.0;  ///< Belsley's index of column-scaled Phi, [10, 1e6]

  /// The first field out of its range, as a refusal naming field, value and range.
  std::optional<Refusal> Validate() const;
};

/// Coefficients the data move only together, as positions in the equation's regressors.
struct CollinearGroup {
  std::vector<std::size_t> columns;
  double condition_index = 0.0;
};

/// What the data can say about one equation.
struct Excitation {
  Equation equation = Equation::kUnknown;
  std::vector<std::size_t> excited;       ///< columns the data move; the others stay out of the fit
  Eigen::VectorXd column_norms;           ///< of the excited columns
  TriangularFactor factor;                ///< of the excited columns, scaled to unit norm
  Eigen::VectorXd singular_values;        ///< of that scaled triangle, descending
  Eigen::MatrixXd left_singular_vectors;  ///< of that triangle, columns in the same order
  Eigen::MatrixXd right_singular_vectors;
  Eigen::Index rank = 0;
  std::vector<CollinearGroup> collinear;
};

/// Can this equation be answered from these rows? Verdicts do not depend on the units of any
/// column: columns are scaled to unit norm first. Refuses when: rows are too few, or the motion or
/// the command hardly varies. Source: Belsley, Kuh, Welsch, "Regression Diagnostics", 1980, chapter
/// 3 (condition indices and variance-decomposition proportions).
Result<Excitation> Assess(const EquationProblem& problem, const ExcitationLimits& limits);

/// The same of surge, sway and yaw. Sway and yaw have the same regressors: from the same rows they
/// are decomposed once.
std::array<Result<Excitation>, 3> Assess(const std::array<EquationProblem, 3>& problems,
                                         const ExcitationLimits& limits);

/// What a collinear group means for an operator.
Refusal Explain(const CollinearGroup& group, const EquationProblem& problem);

}  // namespace telltale
