#pragma once

#include <limits>
#include <optional>

#include <Eigen/Core>

#include "telltale/core/estimation/output_error/shared_unknowns.hpp"
#include "telltale/core/estimation/output_error/shooting_plan.hpp"

namespace telltale {

/// The scale by which residuals are divided: each sensor's noise times `position` or `heading`. A
/// factor exceeds one where more than sensor noise separates model and measurement. Beyond
/// `huber_threshold` scales a residual counts in proportion and not by its square (Huber). A fix
/// counts by its distance.
struct NoiseScale {
  double position = 1.0;
  double heading = 1.0;
  double huber_threshold = std::numeric_limits<double>::infinity();
};

using RowMajorMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// The residuals of a shooting segment: model less measurement, divided by the noise scale. Beyond
/// the Huber threshold they are reduced such that their square is Huber's loss. In the order of the
/// nodes: north and east of a fix, then the mean heading.
struct ShootingResidual {
  Eigen::VectorXd residual;
  RowMajorMatrix by_start;   ///< n x 6
  RowMajorMatrix by_shared;  ///< n x P
};

/// Simulates a shooting segment, docs/concepts/model.md (50), (51): Runge-Kutta of order four from
/// node to node. The derivatives come from the variational equations along the same steps, so they
/// are exactly those of the residuals. A lagging thrust enters each step with its exact mean.
/// Nothing when the simulation diverges. Requires: theta as long as the shared unknowns.
std::optional<ShootingResidual> ComputeShootingResidual(
    const ShootingPlan& plan, const ShootingSegment& shooting_segment,
    const SharedUnknowns& unknowns, const Eigen::VectorXd& theta, const ShootingState& start,
    const NoiseScale& noise_scale, bool with_derivatives);

}  // namespace telltale
