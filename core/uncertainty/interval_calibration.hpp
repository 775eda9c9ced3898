#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "telltale/core/estimation/regression/parameter_block.hpp"

namespace telltale {

/// How far a twin's estimate was off the boat it was sailed with, and the covariance that it made
/// of its own clusters. Both in one kind of coordinates: whitened ones or those of the unknowns.
struct ReplicateError {
  Eigen::VectorXd error;
  Eigen::MatrixXd covariance;
};

/// False where instruments all but vanished and numbers overflowed.
bool IsUsable(const ReplicateError& replicate_error);

/// What twins tell of an estimate and of the covariance C that clusters gave it.
struct IntervalCalibration {
  Eigen::VectorXd bias;              ///< of the estimate, as unknowns
  Eigen::MatrixXd scale;             ///< covariance that holds: scale C scale', C whitened
  Eigen::VectorXd interval_factors;  ///< by unknown, of its interval's half width beside Student's
  double covariance_factor = 1.0;    ///< of JointBounds
};

/// Tells bias and size of each whitened direction by the twins' errors in standard errors of their
/// own, and stretches those of each block until intervals that each twin makes of its own clusters,
/// sized by the other twins, hold 95 % over the block; each unknown's interval then is as long as
/// holds 95 % of the twins in that unknown. docs/concepts/model.md (33), (35).
/// Assumes: the true boat stands to the twins as each of them stands to the others.
/// Shapes: sightings whitened, so that clusters gave the estimate standard errors of one;
/// unknowns = map * whitened, block by block.
/// Requires: three sightings or more, all sound. Nothing where numbers overflow.
std::optional<IntervalCalibration> CalibrateIntervals(
    const std::vector<ReplicateError>& replicate_errors, const Eigen::MatrixXd& map,
    const std::vector<Block>& blocks, double degrees_of_freedom);

}  // namespace telltale
