#pragma once

#include <vector>

#include <Eigen/Core>

#include "telltale/core/data/prepared_dataset.hpp"
#include "telltale/core/estimation/regression/lagged_regression.hpp"
#include "telltale/core/estimation/regression/one_step.hpp"
#include "telltale/core/estimation/regression/regression_problem.hpp"

namespace telltale {

/// A least-squares fit whose rows come in slices, linear or linearised about its solution: all
/// that bounds are made from. Shapes: W n x r has orthonormal columns, W = Phi basis with basis p x
/// r; residual, instants n; theta, estimable p. clusters[s] is the range of rows that slice s
/// gave, possibly empty; instants[i] is the place in time of row i, which other rows of the same
/// instant share: consecutive rows of a gap-free segment count up by one, and a gap skips at least
/// one. Only moving blocks need the instants.
struct ClusteredFit {
  Eigen::MatrixXd W;
  Eigen::VectorXd residual;
  Eigen::VectorXd theta;
  Eigen::MatrixXd basis;
  std::vector<bool> estimable;  ///< false where theta_j is a part of an undetermined direction
  double residual_variance = 0.0;
  double degrees_of_freedom = 0.0;
  std::vector<RowRange> clusters;
  std::vector<std::size_t> instants;
};

/// Whether replicates are to be drawn from a fit: they alone need W, which is as much work as the
/// rest.
enum class Replicates { kNone, kDrawn };

/// The fit of one equation of the static structure; theta are its excited coefficients. W is left
/// empty where no replicates are drawn. Memory: W takes the place of Phi in a problem that is given
/// away.
ClusteredFit FitOf(EquationProblem problem, const EquationEstimate& estimate,
                   Replicates replicates = Replicates::kDrawn);

/// The joint fit of the dynamic structure, linearised: theta are the time constant and then the
/// excited coefficients of the answered equations.
ClusteredFit FitOf(const LaggedEstimate& estimate);

/// sigma^2 (Phi'Phi)^-1, what white residuals would mean for theta.
Eigen::MatrixXd ResidualCovariance(const ClusteredFit& fit);

}  // namespace telltale
