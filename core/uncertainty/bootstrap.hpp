#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "telltale/core/uncertainty/clustered_fit.hpp"
#include "telltale/core/uncertainty/interval.hpp"

namespace telltale {

/// What a replicate redraws. kSlices: whole slices, which stand for independent manoeuvres.
/// kMovingBlocks: blocks of consecutive instants, for residuals that stay coloured for far shorter
/// than a slice lasts, or slices too few to be drawn. kParametric: nothing; the data set is
/// simulated anew (SimulateReplicates), which shows the bias of the estimator too.
enum class Resampling { kUnknown, kSlices, kMovingBlocks, kParametric };

std::string_view Name(Resampling resampling);

struct BootstrapOptions {
  std::size_t replicates = 1000;  ///< [100, 100000]
  std::uint64_t seed = 1;
  std::size_t threads = 1;  ///< [1, 256]
  Resampling resampling = Resampling::kSlices;
  IntervalMethod interval = IntervalMethod::kPercentile;  ///< what the replicates are to serve
  std::size_t block_length = 0;  ///< of moving blocks, instants; 0: chosen from the data
};

/// Coefficients are stacked in the order of the fits, p in all.
/// Shapes: theta p x (solved replicates), estimate p. For studentized intervals also standard_error
/// p and standard_errors like theta, for BCa acceleration p; empty otherwise.
struct BootstrapReplicates {
  Eigen::MatrixXd theta;
  std::size_t failures = 0;  ///< draws whose normal equations were singular, left out
  Eigen::VectorXd estimate;
  std::size_t block_length = 0;  ///< instants; 0 for slices
  std::size_t draws = 0;         ///< units drawn for each replicate
  Eigen::VectorXd standard_error;
  Eigen::MatrixXd standard_errors;
  Eigen::VectorXd acceleration;
};

/// Each replicate draws as many units of rows as cover the data once, with replacement, the same
/// draw for every fit, so that covariances between equations come with it.
/// Units: slices (the pairs cluster bootstrap), or circular blocks of a common length inside each
/// run of instants without a gap, that length from BlockLength() of the influence of each instant
/// on each coefficient. A run shorter than a block is drawn whole, and as often as its instants
/// need, so each instant is drawn once on average.
/// Method: a unit is only its normal equations W_u'W_u x = W_u'e_u; a replicate adds those drawn
/// and solves an r x r system near the identity, theta* = theta + basis x. Its standard errors, for
/// studentized intervals, are those of the cluster covariance of its own units, scores W_u'e_u -
/// W_u'W_u x. The acceleration, for BCa, comes from leaving out one slice at a time, or one of
/// the blocks laid end to end. For a linearised fit a replicate is one Gauss-Newton step from the
/// solution.
/// Cost: O(n r^2) once for a batch of some hundred replicates, and O(draws r^2 + r^3) each.
/// Determinism: replicate i has a random engine of its own, so the result does not depend on
/// threads.
/// Requires: slices or blocks; at least one fit; for slices all with the same number of
/// clusters, at least one; for blocks the instants of all rows.
/// Source: Cameron, Gelbach, Miller, "Bootstrap-based improvements for inference with clustered
/// errors", Review of Economics and Statistics 90 (2008); Politis, Romano, "A circular
/// block-resampling procedure for stationary data", in "Exploring the Limits of Bootstrap" (1992);
/// Goetze, Kuensch, "Second-order correctness of the blockwise bootstrap for stationary
/// observations", Annals of Statistics 24 (1996).
BootstrapReplicates Bootstrap(const std::vector<ClusteredFit>& fits,
                              const BootstrapOptions& options);

/// Sample covariance of the replicates.
Eigen::MatrixXd Covariance(const BootstrapReplicates& replicates);

/// The interval of every coefficient, by the method the replicates were drawn for. Unbounded where
/// a studentized one has no standard error to go by. Needs at least two replicates.
std::vector<Interval> Intervals(const BootstrapReplicates& replicates, IntervalMethod method,
                                double level);

}  // namespace telltale
