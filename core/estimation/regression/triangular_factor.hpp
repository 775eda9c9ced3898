#pragma once

#include <vector>

#include <Eigen/Core>

namespace telltale {

/// Model: the least-squares problem min |y - Phi theta| reduced to a triangle, Q'[Phi y] = [R z; 0
/// rho]. Shapes: R p x p upper triangular, z p; rho^2 is the residual sum of squares; rows is n.
/// Unlike the normal equations this keeps the condition number of Phi unsquared.
struct TriangularFactor {
  Eigen::MatrixXd R;
  Eigen::VectorXd z;
  double rho = 0.0;
  Eigen::Index rows = 0;
};

/// Householder QR of [Phi y] in blocks of rows small enough to stay in cache.
/// Source: Demmel, Grigori, Hoemmen, Langou, "Communication-optimal parallel and sequential QR and
/// LU factorizations", SIAM J. Sci. Comput. 34 (2012), the sequential variant.
TriangularFactor Triangularise(const Eigen::Ref<const Eigen::MatrixXd>& phi,
                               const Eigen::Ref<const Eigen::VectorXd>& y);

/// The same for several y, columns of Y, at little more than the cost of one: one factor for each.
std::vector<TriangularFactor> TriangulariseAll(const Eigen::Ref<const Eigen::MatrixXd>& phi,
                                               const Eigen::Ref<const Eigen::MatrixXd>& Y);

}  // namespace telltale
