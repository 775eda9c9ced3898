#pragma once

#include <cstddef>

#include <Eigen/Core>

#include "telltale/core/estimation/weak_form/weak_fit.hpp"

namespace telltale {

/// Lags, in supports, up to which the residuals of neighbouring supports are autocorrelated.
inline constexpr std::size_t kSupportResidualLags = 20;

/// Cov(Z'e) of one equation if its residuals are stationary, with their average autocovariance.
/// Shapes: residual one per support, Z supports x unknowns.
Eigen::MatrixXd StationaryMeat(const WeakProblem& problem, std::size_t equation,
                               const Eigen::VectorXd& residual, const Eigen::MatrixXd& Z);

/// Cov(theta) from the scores of the clusters, shrunk by p / (p + g) towards the shape that
/// stationary residuals would give it. The scores of g clusters alone leave the covariance singular
/// or nearly so when p is not far below g.
/// Requires: at least two clusters.
Eigen::MatrixXd ClusterCovariance(const WeakFit& fit);

}  // namespace telltale
