#include "telltale/core/estimation/weak_form/stacked_system.hpp"

#include "telltale/core/base/linear_algebra/covariance.hpp"
#include "telltale/core/base/linear_algebra/eigen_decompositions.hpp"

namespace telltale {
namespace {

Eigen::MatrixXd Prepend(const Eigen::VectorXd& first, const Eigen::MatrixXd& others) {
  Eigen::MatrixXd all(others.rows(), 1 + others.cols());
  all << first, others;
  return all;
}

}  // namespace

StackedSystem StackEquations(const ProjectedEquations& equations,
                             const std::vector<Eigen::MatrixXd>& Z,
                             const std::vector<Eigen::MatrixXd>& by_lag,
                             const std::vector<double>& weights) {
  const bool lagging = !by_lag.empty();
  Eigen::Index P = lagging ? 1 : 0;
  for (const ProjectedEquation& equation : equations) P += equation.G.cols();
  StackedSystem system{Eigen::MatrixXd::Zero(P, P), Eigen::VectorXd::Zero(P), {}};
  Eigen::Index next = lagging ? 1 : 0;
  for (std::size_t i = 0; i < equations.size(); ++i) {
    const ProjectedEquation& equation = equations[i];
    StackedEquation stacked;
    if (lagging) stacked.places.push_back(0);
    for (Eigen::Index j = 0; j < equation.G.cols(); ++j) stacked.places.push_back(next++);
    stacked.Z = lagging ? Prepend(weights[i] * by_lag[i], Z[i]) : Z[i];
    system.A(stacked.places, stacked.places) +=
        stacked.Z.transpose() * (lagging ? Prepend(by_lag[i], equation.G) : equation.G);
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
