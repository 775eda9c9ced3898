#pragma once

#include <optional>

#include "telltale/core/data/samples.hpp"
#include "telltale/core/identification/identification.hpp"
#include "telltale/core/vessel/vehicle.hpp"
#include "telltale/service/models/model_store.hpp"

namespace telltale {

/// RMS free-run error of the model over 5 s windows of a recording, per velocity. Nothing when the
/// model lacks an equation or the recording holds no 5 s without a gap.
std::optional<FreeRunError> MeasureFreeRunError(const Recording& recording, const Vehicle& vehicle,
                                                const Identification& identification);

/// `now` in units of `reference`: the root mean square over the three velocities of their ratios.
double RelativeError(const FreeRunError& now, const FreeRunError& reference);

}  // namespace telltale
