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

/// By how much the timing of one recording may differ from the model's, in s: normal priors. Where
/// the time constant hardly may, a thrust that comes later is a delay.
struct TimingPrior {
  double time_constant_sd_s = 0.0;
  double delay_sd_s = 0.0;  ///< of commands and of fixes
};

/// What one more recording of a boat says of it, beside a model of the boat: the search begins at
/// that model and the prior stands about it, but for the timing as wide as that of a boat that
/// nothing is known of. The boat may have changed since. Several times as fast as a model from
/// nothing. Refuses when: the fit does not converge.
Result<PhysicalModel> PhysicalModelAbout(const PhysicalModel& model, const TimingPrior& timing,
                                         const PreparedDataset& dataset, const Vehicle& vehicle,
                                         const IdentifyOptions& options);

}  // namespace telltale
