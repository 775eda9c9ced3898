#include "telltale/core/estimation/weak_form/stacked_system.hpp"

#include "telltale/core/base/linear_algebra/covariance.hpp"
#include "telltale/core/base/linear_algebra/eigen_decompositions.hpp"

namespace telltale {
namespace {

Eigen::Index ColumnsOf(const std::vector<Eigen::MatrixXd>& derivatives) {
  return derivatives.empty() ? 0 : derivatives.front().cols();
}

/// The columns of one equation: by the time constant, of its coefficients, by the delays; those of
/// shared unknowns multiplied by `weight`.
Eigen::MatrixXd Beside(const SharedDerivatives& shared, std::size_t i, const Eigen::MatrixXd& own,
                       double weight) {
  const Eigen::Index lags = ColumnsOf(shared.by_lag);
  const Eigen::Index delays = ColumnsOf(shared.by_delay);
  Eigen::MatrixXd all(own.rows(), lags + own.cols() + delays);
  if (lags > 0) all.leftCols(lags) = weight * shared.by_lag[i];
  all.middleCols(lags, own.cols()) = own;
  if (delays > 0) all.rightCols(delays) = weight * shared.by_delay[i];
  return all;
}

}  // namespace

StackedSystem StackEquations(const ProjectedEquations& equations,
                             const std::vector<Eigen::MatrixXd>& Z, const SharedDerivatives& shared,
                             const std::vector<double>& weights) {
  const Eigen::Index lags = ColumnsOf(shared.by_lag);
  const Eigen::Index delays = ColumnsOf(shared.by_delay);
  Eigen::Index P = lags + delays;
  for (const ProjectedEquation& equation : equations) P += equation.G.cols();
  StackedSystem system{Eigen::MatrixXd::Zero(P, P), Eigen::VectorXd::Zero(P), {}};
  Eigen::Index next = lags;
  for (std::size_t i = 0; i < equations.size(); ++i) {
    const ProjectedEquation& equation = equations[i];
    StackedEquation stacked;
    for (Eigen::Index j = 0; j < lags; ++j) stacked.places.push_back(j);
    for (Eigen::Index j = 0; j < equation.G.cols(); ++j) stacked.places.push_back(next++);
    for (Eigen::Index j = P - delays; j < P; ++j) stacked.places.push_back(j);
    stacked.Z = Beside(shared, i, Z[i], weights[i]);
    system.A(stacked.places, stacked.places) +=
        stacked.Z.transpose() * Beside(shared, i, equation.G, 1.0);
    system.c(stacked.places) += stacked.Z.transpose() * equation.b;
    system.equations.push_back(std::move(stacked));
  }
  return system;
}

std::optional<Eigen::MatrixXd> InvertScaled(const Eigen::MatrixXd& A) {
  const Eigen::VectorXd rows = A.rowwise().norm();
  if (!A.allFinite() || (rows.array() <= 0.0).any()) return std::nullopt;
  const Eigen::VectorXd scale = rows.cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd scaled = Scaled(A, scale);
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> decomposition;
  decomposition.setThreshold(1e-12).compute(scaled);
  if (decomposition.rank() < A.rows()) return std::nullopt;
  const Eigen::MatrixXd inverse = decomposition.pseudoInverse();
  return Scaled(inverse, scale);
}

void UnstackThetas(const Eigen::VectorXd& stacked, Eigen::Index first, Thetas& thetas) {
  for (Eigen::VectorXd& theta : thetas) {
    theta = stacked.segment(first, theta.size());
    first += theta.size();
  }
}

}  // namespace telltale
