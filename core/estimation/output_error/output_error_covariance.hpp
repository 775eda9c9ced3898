#pragma once

#include <Eigen/Core>

#include "telltale/core/estimation/output_error/output_error.hpp"

namespace telltale {

/// The cluster sandwich H^-1 (sum_s q_s q_s') H^-1. Each cluster's residuals are those of a theta
/// fitted without it: leave-one-out, to first order, q_s multiplied by (H - H_s)^-1. Without that,
/// P unknowns fitted to g clusters leave residuals that understate their variance.
/// Bounds: Student's t with g - 1 degrees of freedom. Requires: at least two clusters.
Eigen::MatrixXd ClusterCovariance(const OutputErrorFit& fit);

/// s^2 H^-1: the covariance of theta if residuals are white.
Eigen::MatrixXd NaiveCovariance(const OutputErrorFit& fit);

/// The ratio of cluster to naive standard errors, docs/concepts/model.md (54): the geometric mean
/// over the separable coefficients of an equation, in the equation where it is largest; zero if
/// there are none. It is near one where residuals are white noise. A value well above one shows a
/// disturbance or a missing term.
double Misspecification(const OutputErrorFit& fit);

}  // namespace telltale
