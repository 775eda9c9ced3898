#pragma once

#include <Eigen/Core>

#include "telltale/core/estimation/weak_form/weak_fit.hpp"

namespace telltale {

/// A normal posterior of the stacked unknowns.
struct RidgePosterior {
  Eigen::VectorXd posterior_mean;
  Eigen::MatrixXd covariance;
};

/// The posterior under a normal prior, docs/concepts/model.md (34). The prior gives the force of
/// every coefficient, its column of G times the coefficient, zero mean and one variance. That
/// variance is chosen such that
///   (theta - mean)' Cov^-1 (theta - mean) = prior_scale P
/// while the truth is expected where this is P. Where regressors are nearly collinear the estimate
/// itself is ill-determined and far from any likely truth; the posterior mean is not.
RidgePosterior RidgePosteriorOf(const WeakFit& fit, double prior_scale);

}  // namespace telltale
