#pragma once

#include <Eigen/Core>

namespace telltale {

/// The Gram matrix of columns, A' A, symmetric to the last digit. Half the work of the product.
Eigen::MatrixXd Gram(const Eigen::MatrixXd& A);

}  // namespace telltale
