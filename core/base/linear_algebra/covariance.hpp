#pragma once

#include <Eigen/Core>

namespace telltale {

/// Diag(scale) V diag(scale): a covariance V in other units; over standard errors, its
/// correlations.
Eigen::MatrixXd Scaled(const Eigen::MatrixXd& V, const Eigen::VectorXd& scale);

/// A V A': the covariance of A x where V is that of x. Symmetric to the last digit, since readers
/// of a model ask that of a covariance however wild its numbers are.
Eigen::MatrixXd Mapped(const Eigen::MatrixXd& A, const Eigen::MatrixXd& V);

/// Root root': the covariance of root z where z is white.
Eigen::MatrixXd OfRoot(const Eigen::MatrixXd& root);

/// Of a positive definite matrix: a covariance of its information, or the other way round.
Eigen::MatrixXd Inverse(const Eigen::MatrixXd& V);

}  // namespace telltale
