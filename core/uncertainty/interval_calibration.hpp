#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "telltale/core/estimation/regression/parameter_block.hpp"

namespace telltale {

/// The error of a replicate's estimate and the covariance of its own clusters. Both in one kind of
/// coordinates: whitened ones or those of the unknowns.
struct ReplicateError {
  Eigen::VectorXd error;
  Eigen::MatrixXd covariance;
};

/// False where weak instruments make numbers overflow.
bool IsUsable(const ReplicateError& replicate_error);

/// The calibration of an estimate and of its clusters' covariance C.
struct IntervalCalibration {
  Eigen::VectorXd bias;              ///< of the estimate, as unknowns
  Eigen::MatrixXd scale;             ///< covariance that holds: scale C scale', C whitened
  Eigen::VectorXd interval_factors;  ///< by unknown, of its interval's half width beside Student's
  double covariance_factor = 1.0;    ///< of JointBounds
};

/// Bias and size of each whitened direction from the replicates' errors in standard errors of their
/// own. Each replicate's intervals, with sizes from the other replicates, give the inflation factor
/// of each block with which they hold 95 % over the block. Each unknown's interval is as long as
/// holds 95 % of the replicates in that unknown. docs/concepts/model.md (33), (35).
/// Assumes: the true model stands to the replicates as each of them stands to the others.
/// Shapes: replicate errors whitened, so that the estimate's clusters give standard errors of one;
/// unknowns = map * whitened, block by block.
/// Requires: three usable replicate errors or more. Nothing where numbers overflow.
std::optional<IntervalCalibration> CalibrateIntervals(
    const std::vector<ReplicateError>& replicate_errors, const Eigen::MatrixXd& map,
    const std::vector<Block>& blocks, double degrees_of_freedom);

}  // namespace telltale
