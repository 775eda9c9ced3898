#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "uncertainty/clustered_fit.hpp"

namespace telltale {

struct BootstrapOptions {
  std::size_t replicates = 1000;  ///< [100, 100000]
  std::uint64_t seed = 1;
  std::size_t threads = 1;  ///< [1, 256]
};

/// Shapes: theta is (sum of p over the fits) x solved replicates, in the order of the fits.
struct BootstrapReplicates {
  Eigen::MatrixXd theta;
  std::size_t failures = 0;  ///< draws whose normal equations were singular, left out
};

/// The cluster bootstrap: each replicate draws as many segments as there are, with replacement, the
/// same draw for every fit, so that covariances between equations come with it. Method: each
/// segment's Gram matrix W_s'W_s and score W_s'e_s are formed once; a replicate adds the drawn ones
/// and solves an r x r system near the identity. For a linearised fit that is one Gauss-Newton step
/// from the solution. Determinism: replicate i has a random engine of its own, so the result does
/// not depend on threads. Source: Cameron, Gelbach, Miller, "Bootstrap-based improvements for
/// inference with clustered errors", Review of Economics and Statistics 90 (2008), pairs cluster
/// bootstrap. Requires: at least one fit; all with the same number of clusters, at least one.
BootstrapReplicates BootstrapSegments(const std::vector<ClusteredFit>& fits,
                                      const BootstrapOptions& options);

/// Sample covariance of the replicates.
Eigen::MatrixXd Covariance(const BootstrapReplicates& replicates);

}  // namespace telltale
