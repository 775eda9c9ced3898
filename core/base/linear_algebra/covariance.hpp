#pragma once

#include <Eigen/Core>

namespace telltale {

/// diag(scale) V diag(scale): the covariance V in other units. With the inverse standard errors as
/// scale these are its correlations.
Eigen::MatrixXd Scaled(const Eigen::MatrixXd& V, const Eigen::VectorXd& scale);

/// A V A': the covariance of A x where V is that of x. It is symmetric to the last digit, which
/// readers of a stored model require.
Eigen::MatrixXd Mapped(const Eigen::MatrixXd& A, const Eigen::MatrixXd& V);

/// root root': the covariance of root z where z is white with unit variance.
Eigen::MatrixXd OfRoot(const Eigen::MatrixXd& root);

/// The sample covariance of columns. Requires: two columns at least.
Eigen::MatrixXd OfColumns(const Eigen::MatrixXd& columns);

/// The inverse of a positive definite matrix: of a covariance its information, and the reverse.
Eigen::MatrixXd Inverse(const Eigen::MatrixXd& V);

}  // namespace telltale
