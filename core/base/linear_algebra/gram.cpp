#include "telltale/core/base/linear_algebra/gram.hpp"

#include "telltale/core/base/linear_algebra/eigen_decompositions.hpp"

namespace telltale {

Eigen::MatrixXd Gram(const Eigen::MatrixXd& A) {
  Eigen::MatrixXd gram = Eigen::MatrixXd::Zero(A.cols(), A.cols());
  gram.selfadjointView<Eigen::Lower>().rankUpdate(A.transpose());
  gram.triangularView<Eigen::StrictlyUpper>() = gram.transpose();
  return gram;
}

}  // namespace telltale
