#pragma once

#include <array>
#include <limits>

#include <Eigen/Core>

#include "telltale/core/identification/identification.hpp"
#include "telltale/core/vessel/vessel_model.hpp"

namespace telltale {

/// The prior scale of unregularised estimates.
inline constexpr double kUnregularised = std::numeric_limits<double>::infinity();

/// Prior scales in units of the estimates, tried in turn until a model can be simulated.
inline constexpr std::array kRelativePriorScales = {1.0, 0.7, 0.5, 0.35, 0.25, 0.18, 0.125};

/// The posterior mean under independent normal priors, docs/concepts/model.md (61): theta' = b + P
/// (P + Sigma)^-1 (theta - b) with P = diag(prior_scales^2) and b the prior means. Ill-determined
/// combinations are shrunk towards b; well-determined ones stay. A coefficient of infinite
/// variance, or of prior scale zero, keeps its estimate. Shapes: one prior scale and mean a
/// coefficient.
Eigen::VectorXd RegularisedEstimates(const Identification& identification,
                                     const Eigen::VectorXd& prior_scales,
                                     const Eigen::VectorXd& prior_means);

/// The continuous-time model with coefficients shrunk towards zero, their prior scales being
/// `prior_scale` times the sizes of the estimates. Unknown coefficients, and those of a refused
/// equation, are zero.
VesselModel RegularisedModel(const Identification& identification, double prior_scale);

}  // namespace telltale
