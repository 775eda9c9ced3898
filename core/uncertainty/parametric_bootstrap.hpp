#pragma once

#include <functional>
#include <optional>

#include <Eigen/Core>

#include "telltale/core/data/prepared_dataset.hpp"
#include "telltale/core/uncertainty/bootstrap.hpp"
#include "telltale/core/vessel/disturbance.hpp"
#include "telltale/core/vessel/vessel_model.hpp"

namespace telltale {

/// What an estimator makes of a data set, by white residuals.
struct Refit {
  Eigen::VectorXd theta;
  Eigen::VectorXd standard_error;
};

/// Parametric bootstrap: each replicate is what the estimator makes of a simulated repeat of the
/// data set, sailed by its own estimate with fresh disturbance and sensor noise (SimulateDataset)
/// and prepared anew. Unlike redrawn rows, repeats show the bias of the estimator too. Studentized
/// intervals take it out to first order; what is left is by how much the bias at the estimate
/// differs from that at the truth. Percentiles count it twice, and BCa takes out no more than two
/// standard errors or so, for its bounds are replicates (its acceleration is zero: the residuals
/// simulated are Gaussian). Repeats that run away or of which the estimator makes nothing count as
/// failures. Determinism: replicate i has a seed of its own, so the result does not depend on
/// threads. Requires: `reestimate` to be safe on several threads.
BootstrapReplicates SimulateReplicates(
    const PreparedDataset& dataset, const VesselModel& model, const Disturbance& disturbance,
    const Refit& original,
    const std::function<std::optional<Refit>(const PreparedDataset&)>& reestimate,
    const BootstrapOptions& options);

}  // namespace telltale
