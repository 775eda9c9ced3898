#pragma once

#include <cstddef>
#include <cstdint>

#include <Eigen/Core>

namespace telltale {

/// Draws from a normal law that is truncated to a box, one a column: Gibbs sampling from `start`,
/// twenty sweeps between draws. Determinism: the same seed gives the same draws.
/// Requires: a positive definite covariance, least <= start <= greatest.
/// Source: Robert, Simulation of truncated normal variables, Statistics and Computing 5, 1995.
Eigen::MatrixXd DrawTruncatedNormal(const Eigen::VectorXd& mean, const Eigen::MatrixXd& covariance,
                                    const Eigen::VectorXd& least, const Eigen::VectorXd& greatest,
                                    const Eigen::VectorXd& start, std::size_t count,
                                    std::uint64_t seed);

}  // namespace telltale
