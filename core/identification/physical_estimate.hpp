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

/// What one more recording of a boat says of it, beside a model of the boat: the search begins at
/// that model and the prior stands about it, as wide as that of a boat that nothing is known of.
/// The boat may have changed since. The time constant of its propellers alone is kept to so much of
/// the model's: a thrust that comes later is then a delay. Several times as fast as a model from
/// nothing. Refuses when: the fit does not converge.
Result<PhysicalModel> PhysicalModelAbout(const PhysicalModel& model, double time_constant_sd_s,
                                         const PreparedDataset& dataset, const Vehicle& vehicle,
                                         const IdentifyOptions& options);

}  // namespace telltale
