#include "telltale/core/base/linear_algebra/covariance.hpp"

#include "telltale/core/base/linear_algebra/eigen_decompositions.hpp"

namespace telltale {

Eigen::MatrixXd Scaled(const Eigen::MatrixXd& V, const Eigen::VectorXd& scale) {
  return scale.asDiagonal() * V * scale.asDiagonal();
}

Eigen::MatrixXd Mapped(const Eigen::MatrixXd& A, const Eigen::MatrixXd& V) {
  const Eigen::MatrixXd once = A * V;
  const Eigen::MatrixXd mapped = once * A.transpose();
  return 0.5 * (mapped + mapped.transpose());  // halves of the matrix differ by rounding
}

Eigen::MatrixXd OfRoot(const Eigen::MatrixXd& root) {
  return root * root.transpose();
}

Eigen::MatrixXd OfColumns(const Eigen::MatrixXd& columns) {
  const Eigen::MatrixXd centred = columns.colwise() - columns.rowwise().mean();
  return centred * centred.transpose() / static_cast<double>(centred.cols() - 1);
}

Eigen::MatrixXd Inverse(const Eigen::MatrixXd& V) {
  const Eigen::MatrixXd identity = Eigen::MatrixXd::Identity(V.rows(), V.cols());
  return V.llt().solve(identity);
}

}  // namespace telltale
