#include "telltale/core/uncertainty/clustered_fit.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "telltale/core/base/linear_algebra/covariance.hpp"
#include "telltale/core/base/linear_algebra/eigen_decompositions.hpp"
#include "telltale/core/estimation/regression/excitation.hpp"
#include "telltale/core/estimation/regression/triangular_factor.hpp"

namespace telltale {
namespace {

Eigen::VectorXd Stack(const LaggedEstimate& estimate) {
  Eigen::VectorXd theta(estimate.jacobian.cols());
  theta[0] = estimate.time_constant_s;
  Eigen::Index next = 1;
  for (const auto& equation : estimate.equations) {
    if (!equation) continue;
    theta.segment(next, equation->theta.size()) = equation->theta;
    next += equation->theta.size();
  }
  return theta;
}

/// Phi's columns times the basis, row for row in the place of Phi.
Eigen::MatrixXd InPlace(Eigen::MatrixXd phi, const std::vector<std::size_t>& columns,
                        const Eigen::MatrixXd& basis) {
  constexpr Eigen::Index kRowsAtOnce = 1024;
  for (Eigen::Index first = 0; first < phi.rows(); first += kRowsAtOnce) {
    auto rows = phi.middleRows(first, std::min(kRowsAtOnce, phi.rows() - first));
    const Eigen::MatrixXd product = rows(Eigen::all, columns) * basis;
    rows.leftCols(basis.cols()) = product;
  }
  phi.conservativeResize(Eigen::NoChange, basis.cols());
  return phi;
}

}  // namespace

ClusteredFit FitOf(EquationProblem problem, const EquationEstimate& estimate,
                   Replicates replicates) {
  ClusteredFit fit;
  Eigen::VectorXd theta = Eigen::VectorXd::Zero(problem.phi.cols());
  theta(estimate.columns) = estimate.theta;
  fit.residual = problem.y - problem.phi * theta;
  if (replicates == Replicates::kDrawn) {
    fit.W = InPlace(std::move(problem.phi), estimate.columns, estimate.basis);
  }
  fit.theta = estimate.theta;
  fit.basis = estimate.basis;
  fit.estimable = estimate.estimable;
  fit.residual_variance = estimate.residual_variance;
  fit.degrees_of_freedom = estimate.degrees_of_freedom;
  fit.clusters = std::move(problem.clusters);
  fit.instants = std::move(problem.instants);
  return fit;
}

ClusteredFit FitOf(const LaggedEstimate& estimate) {
  const Eigen::VectorXd norms =
      estimate.jacobian.colwise().norm().transpose().cwiseMax(std::numeric_limits<double>::min());
  const TriangularFactor factor =
      Triangularise(estimate.jacobian * norms.cwiseInverse().asDiagonal(), estimate.residual);
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(factor.R, Eigen::ComputeFullV);
  const Eigen::VectorXd& s = svd.singularValues();
  const double smallest =
      s[0] * std::numeric_limits<double>::epsilon() * static_cast<double>(estimate.jacobian.rows());
  const Eigen::Index rank = (s.array() > smallest).count();
  const Eigen::Index p = norms.size();

  ClusteredFit fit;
  fit.basis = norms.cwiseInverse().asDiagonal() * svd.matrixV().leftCols(rank) *
              s.head(rank).cwiseInverse().asDiagonal();
  fit.W = estimate.jacobian * fit.basis;
  fit.residual = estimate.residual;
  fit.theta = Stack(estimate);
  for (Eigen::Index j = 0; j < p; ++j) {
    fit.estimable.push_back(svd.matrixV().row(j).tail(p - rank).squaredNorm() < kUndeterminedShare);
  }
  fit.degrees_of_freedom = static_cast<double>(estimate.jacobian.rows() - rank);
  fit.residual_variance = estimate.residual.squaredNorm() / fit.degrees_of_freedom;
  fit.clusters = estimate.clusters;
  fit.instants = estimate.instants;
  return fit;
}

Eigen::MatrixXd ResidualCovariance(const ClusteredFit& fit) {
  return fit.residual_variance * OfRoot(fit.basis);
}

}  // namespace telltale
