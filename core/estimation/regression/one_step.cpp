#include "telltale/core/estimation/regression/one_step.hpp"

#include <cmath>

namespace telltale {
EquationEstimate EstimateOneStep(const Excitation& excitation) {
  const Eigen::Index p = excitation.column_norms.size();
  const Eigen::Index rank = excitation.rank;
  const Eigen::MatrixXd& V = excitation.right_singular_vectors;
  const Eigen::VectorXd s = excitation.singular_values.head(rank);

  EquationEstimate estimate;
  estimate.equation = excitation.equation;
  estimate.columns = excitation.excited;
  estimate.basis = excitation.column_norms.cwiseInverse().asDiagonal() * V.leftCols(rank) *
                   s.cwiseInverse().asDiagonal();
  // With R = U S V', the coordinates of y in the orthonormal columns Phi basis are U'z.
  const auto U = excitation.left_singular_vectors.leftCols(rank);
  const Eigen::VectorXd coordinates = U.transpose() * excitation.factor.z;
  estimate.theta = estimate.basis * coordinates;
  for (Eigen::Index j = 0; j < p; ++j) {
    const double share = V.row(j).tail(p - rank).squaredNorm();
    estimate.estimable.push_back(share < kUndeterminedShare);
  }

  // What the undetermined directions of R leave of z is residual too.
  const double undetermined = (excitation.factor.z - U * coordinates).norm();
  const double squares = std::pow(excitation.factor.rho, 2) + std::pow(undetermined, 2);
  estimate.degrees_of_freedom = static_cast<double>(excitation.factor.rows - rank);
  estimate.residual_variance = squares / estimate.degrees_of_freedom;
  return estimate;
}

}  // namespace telltale
