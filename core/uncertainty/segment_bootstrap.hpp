#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include <Eigen/Core>

#include "estimation/one_step.hpp"
#include "estimation/regression_problem.hpp"

namespace telltale {

struct BootstrapOptions {
  std::size_t replicates = 1000;  ///< [100, 100000]
  std::uint64_t seed = 1;
  std::size_t threads = 1;        ///< [1, 256]
};

/// Replicates of the coefficients of all equations that have an estimate.
/// Shapes: theta is (sum of p_j) x solved replicates, equations in the order surge, sway, yaw, excited
/// columns within each.
struct BootstrapReplicates {
  Eigen::MatrixXd theta;
  std::size_t failures = 0;  ///< draws whose normal equations were singular, left out
};

/// The cluster bootstrap: each replicate draws as many segments as there are, with replacement, the same
/// draw for the three equations, so that covariances between equations come with it.
/// Method: in the orthonormal columns W = Phi basis each segment's Gram matrix W_s'W_s and score W_s'e_s
/// are formed once; a replicate adds the drawn ones and solves a p x p system near the identity.
/// Determinism: replicate i has a random engine of its own, so the result does not depend on threads.
/// Source: Cameron, Gelbach, Miller, "Bootstrap-based improvements for inference with clustered
/// errors", Review of Economics and Statistics 90 (2008), pairs cluster bootstrap.
BootstrapReplicates BootstrapSegments(
    const RegressionProblem& problem,
    const std::array<std::optional<EquationEstimate>, 3>& estimates,
    const BootstrapOptions& options);

/// Sample covariance of the replicates.
Eigen::MatrixXd Covariance(const BootstrapReplicates& replicates);

}  // namespace telltale
