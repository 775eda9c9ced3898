#pragma once

#include <Eigen/Core>

#include "telltale/core/diagnosis/hypotheses/effect_posterior.hpp"

namespace telltale {

/// A minimum of the posterior's cost, with the derivatives of the whitened errors. They are those
/// where the last step began, which gained next to nothing.
struct Minimum {
  PosteriorPoint point;
  Eigen::MatrixXd jacobian;
  Eigen::MatrixXd marginalised;  ///< the Jacobian by ResidualMetric::Marginalise
};

/// The minimum of the posterior's cost that Levenberg-Marquardt reaches from `point`.
/// Damping multiplies the diagonal of the information. Steps stay within the bounds of the
/// parameters. The search ends when a step gains less than kDiagnosis.effect_fit.converged_gain, or
/// no step promises anything.
Minimum MinimiseCost(const EffectPosterior& posterior, const PosteriorPoint& point);

}  // namespace telltale
