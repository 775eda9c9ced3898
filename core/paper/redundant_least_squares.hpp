#pragma once

#include <array>
#include <complex>
#include <optional>
#include <span>
#include <string_view>

#include <Eigen/Core>

#include "telltale/core/base/result.hpp"
#include "telltale/core/data/prepared_dataset.hpp"
#include "telltale/core/estimation/regression/regression_problem.hpp"

namespace telltale {

/// One column of the paper's redundant regression, named with the instant it is taken at.
struct RedundantRegressor {
  std::string_view name;
  std::string_view coefficient;
};

/// The columns of the paper's appendix for dynamic propellers: 11 for surge, 21 for sway and for
/// yaw. The body of the paper lists 22 for sway; docs/concepts/model.md gives the reason to follow
/// the appendix.
std::span<const RedundantRegressor> RedundantRegressors(Equation equation);

/// One row of it: nu(k+1) - nu(k) = A(nu(k), nu(k-1), delta(k-1)) X. `row` must be as long as
/// RedundantRegressors(). docs/concepts/model.md (20).
void FillRedundantRow(Equation equation, const Nu& now, const Nu& before,
                      const PropellerCommand& delta_before, std::span<double> row);

/// PreparedDataset -> the redundant regression of one equation, y = (nu(k+1) - nu(k)) / h on A / h,
/// so that its coefficients are X, discrete-time as in the paper's table. Rows as the paper takes
/// them (surge FF; sway and yaw FF, FR, RF, by the command at k-1). `regressors` stays empty: the
/// columns are RedundantRegressors().
EquationProblem BuildRedundant(const PreparedDataset& dataset, Equation equation,
                               const RegressionOptions& options);

/// X of one equation by least squares.
/// Refuses when: fewer rows than ten a column, or collinear columns.
Result<Eigen::VectorXd> EstimateRedundant(const EquationProblem& problem);

/// The alpha that the redundant coefficients imply.
struct RedundantAlpha {
  /// Both roots of alpha^2 - (1 + X1) alpha - X' = 0 for each equation, X' its second linear term.
  std::array<std::array<std::complex<double>, 2>, 3> roots;
  double alpha = 0.0;     ///< in (0, 1), least squares over the three pairs of equations together
  double residual = 0.0;  ///< root mean square misfit of those six equations at that alpha
  bool agree = false;     ///< every equation has a real root in (0, 1) within 0.05 of alpha
};

/// The paper's overdetermined system for alpha, docs/concepts/model.md (21).
RedundantAlpha RecoverAlpha(const std::array<Eigen::VectorXd, 3>& redundant);

}  // namespace telltale
