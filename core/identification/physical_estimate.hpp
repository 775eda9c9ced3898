#pragma once

#include "telltale/core/base/result.hpp"
#include "telltale/core/data/prepared_dataset.hpp"
#include "telltale/core/identification/identification.hpp"
#include "telltale/core/identification/options.hpp"
#include "telltale/core/identification/progress.hpp"
#include "telltale/core/vessel/vehicle.hpp"

namespace telltale {

/// The physical form of a boat from prepared data: its parameters with bounds, and the coefficients
/// that they imply. Bounds are those of the posterior, a normal law truncated to the physical
/// range, whose covariance comes from scores by blocks of time; docs/concepts/physical-model.md
/// (112), (113). Refuses when: the distance between the propellers is not known, the commands
/// hardly change, or the fit does not converge to finite numbers.
Result<Identification> IdentifyPhysicalModel(const PreparedDataset& dataset, const Vehicle& vehicle,
                                             const IdentifyOptions& options,
                                             const Progress& progress);

}  // namespace telltale
