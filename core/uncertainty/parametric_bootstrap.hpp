#pragma once

#include <functional>
#include <optional>

#include <Eigen/Core>

#include "telltale/core/data/prepared_dataset.hpp"
#include "telltale/core/uncertainty/bootstrap.hpp"
#include "telltale/core/vessel/disturbance.hpp"
#include "telltale/core/vessel/vessel_model.hpp"

namespace telltale {

/// The estimate of a dataset, its errors by white residuals.
struct Refit {
  Eigen::VectorXd theta;
  Eigen::VectorXd standard_error;
};

/// Parametric bootstrap: each replicate is the estimate of a synthetic dataset, simulated with the
/// original estimate, fresh disturbance and sensor noise (SimulateDataset), without the readings
/// behind the rows. Unlike redrawn rows,
/// replicates show the bias of the estimator. Studentized intervals correct it to first order and
/// leave the difference of the bias between estimate and truth. Percentiles count it twice. BCa
/// corrects about two standard errors at most, because its bounds are replicates; its acceleration
/// is zero, since the simulated residuals are Gaussian. A replicate that diverges or cannot be
/// estimated counts as a failure. Determinism: replicate i has a seed of its own, so the result
/// does not depend on threads. Requires: `reestimate` to be safe on several threads.
BootstrapReplicates SimulateReplicates(
    const PreparedDataset& dataset, const VesselModel& model, const Disturbance& disturbance,
    const Refit& original,
    const std::function<std::optional<Refit>(const PreparedDataset&)>& reestimate,
    const BootstrapOptions& options);

}  // namespace telltale
