#include "telltale/core/estimation/weak_form/stacked_system.hpp"

#include <utility>

#include "telltale/core/base/linear_algebra/covariance.hpp"
#include "telltale/core/base/linear_algebra/eigen_decompositions.hpp"

namespace telltale {
namespace {

/// The columns of one equation: by the time constant, of its coefficients, by the delays; those of
/// shared unknowns multiplied by `weight`.
Eigen::MatrixXd Beside(const SharedDerivatives& shared, const Eigen::MatrixXd& own, double weight) {
  const Eigen::Index lags = shared.by_lag.cols();
  const Eigen::Index delays = shared.by_delay.cols();
  Eigen::MatrixXd all(own.rows(), lags + own.cols() + delays);
  if (lags > 0) all.leftCols(lags) = weight * shared.by_lag;
  all.middleCols(lags, own.cols()) = own;
  if (delays > 0) all.rightCols(delays) = weight * shared.by_delay;
  return all;
}

}  // namespace

StackedSystem::StackedSystem(const StackedUnknowns& unknowns)
    : A(Eigen::MatrixXd::Zero(unknowns.Count(), unknowns.Count())),
      c(Eigen::VectorXd::Zero(unknowns.Count())),
      unknowns_(unknowns),
      next_(unknowns.lags) {}

void StackedSystem::Add(const ProjectedEquation& equation, const Eigen::MatrixXd& Z,
                        const SharedDerivatives& shared, double weight) {
  StackedEquation stacked;
  for (Eigen::Index j = 0; j < unknowns_.lags; ++j) stacked.places.push_back(j);
  for (Eigen::Index j = 0; j < equation.G.cols(); ++j) stacked.places.push_back(next_++);
  for (Eigen::Index j = c.size() - unknowns_.delays; j < c.size(); ++j) stacked.places.push_back(j);
  stacked.Z = Beside(shared, Z, weight);
  A(stacked.places, stacked.places) += stacked.Z.transpose() * Beside(shared, equation.G, 1.0);
  c(stacked.places) += stacked.Z.transpose() * equation.b;
  equations.push_back(std::move(stacked));
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
