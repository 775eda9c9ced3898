#include "telltale/core/estimation/weak_form/ridge_posterior.hpp"

#include <cmath>

#include "telltale/core/base/linear_algebra/covariance.hpp"
#include "telltale/core/base/linear_algebra/eigen_decompositions.hpp"
#include "telltale/core/estimation/weak_form/projected_equations.hpp"
#include "telltale/core/estimation/weak_form/weak_iv_covariance.hpp"

namespace telltale {
namespace {

/// The norms of the columns of G in the order of the stacked unknowns. That of the time constant is
/// zero: the prior says nothing of it.
Eigen::VectorXd StackedNorms(const WeakFit& fit) {
  Eigen::VectorXd norms = Eigen::VectorXd::Zero(fit.theta.size());
  for (std::size_t j = 0; j < fit.equations.size(); ++j) {
    if (!fit.equations[j]) continue;
    const auto [begin, size] = fit.BlockOf(j);
    norms.segment(begin, size) = ColumnNorms(fit.equations[j]->G);
  }
  return norms;
}

/// The shrinkage of an estimate by prior forces of mean square 1 / weight: gain times its forces.
Eigen::MatrixXd Gain(const Eigen::MatrixXd& covariance, const Eigen::VectorXd& norms,
                     double weight) {
  Eigen::MatrixXd normal = weight * Scaled(covariance, norms);
  normal.diagonal().array() += 1.0;
  const Eigen::MatrixXd moved = norms.asDiagonal() * covariance;
  return weight * normal.ldlt().solve(moved).transpose();
}

}  // namespace

RidgePosterior RidgePosteriorOf(const WeakFit& fit, double prior_scale) {
  constexpr double kLog10Range = 12.0;  // of the weight, about the mean square of the forces
  constexpr int kHalvings = 40;
  const Eigen::MatrixXd covariance = ClusterCovariance(fit);
  const Eigen::VectorXd norms = StackedNorms(fit);
  const Eigen::VectorXd forces = norms.cwiseProduct(fit.theta);
  const auto P = static_cast<double>(fit.theta.size());
  const double mean_square = covariance.diagonal().dot(norms.cwiseAbs2()) / P;
  const auto squared_distance = [&](const Eigen::MatrixXd& gain, double weight) {
    const Eigen::VectorXd shift = gain * forces;
    // Cov^-1 shift = weight norms (forces - norms shift)
    return weight * shift.cwiseProduct(norms).dot(forces - norms.cwiseProduct(shift)) / P;
  };
  double lightest = -kLog10Range;
  double heaviest = kLog10Range;
  Eigen::MatrixXd gain;
  for (int halving = 0; halving < kHalvings; ++halving) {
    const double middle = 0.5 * (lightest + heaviest);
    const double weight = std::pow(10.0, middle) / mean_square;
    gain = Gain(covariance, norms, weight);
    (squared_distance(gain, weight) > prior_scale ? heaviest : lightest) = middle;
  }
  return {fit.theta - gain * forces, covariance - gain * norms.asDiagonal() * covariance};
}

}  // namespace telltale
