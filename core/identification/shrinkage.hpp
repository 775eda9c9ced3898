#pragma once

#include <array>
#include <limits>

#include <Eigen/Core>

#include "telltale/core/identification/identification.hpp"
#include "telltale/core/vessel/vessel_model.hpp"

namespace telltale {

/// Estimates believed as they are.
inline constexpr double kUnregularised = std::numeric_limits<double>::infinity();

/// How large coefficients are believed to be, in units of their estimates, tried in turn until a
/// model can be sailed.
inline constexpr std::array kRelativePriorScales = {1.0, 0.7, 0.5, 0.35, 0.25, 0.18, 0.125};

/// Coefficients that are believed to be of these sizes before any data are seen,
/// docs/concepts/model.md (61), in their order, about what is believed of them: drawn towards it
/// along what the data hardly determine, theta' = b + P (P + Sigma)^-1 (theta - b) with P =
/// diag(sizes^2), they stay where the data are sure. One that is not known, or of size zero, stays
/// as it is. Shapes: sizes, believed, one a coefficient.
Eigen::VectorXd RegularisedEstimates(const Identification& identification,
                                     const Eigen::VectorXd& prior_scales,
                                     const Eigen::VectorXd& prior_means);

/// The continuous boat whose coefficients are believed to be of `trust` times the sizes of their
/// estimates; those that are not known, or whose equation was refused, are zero.
VesselModel RegularisedModel(const Identification& identification, double prior_scale);

}  // namespace telltale
