#pragma once

#include <array>
#include <optional>

#include "telltale/core/data/samples.hpp"
#include "telltale/core/identification/identification.hpp"
#include "telltale/core/vessel/vehicle.hpp"

namespace telltale {

/// RMS free-run error over 5 s: surge, sway (m/s), yaw (rad/s).
using FreeRunError = std::array<double, 3>;

/// The error of a model on a recording. Nothing where the model lacks an equation, where the
/// recording has no 5 s without a gap, and where the model diverges: its size then tells of the
/// model at commands that it does not know, and nothing of the boat.
std::optional<FreeRunError> MeasureFreeRunError(const Recording& recording, const Vehicle& vehicle,
                                                const Identification& identification);

/// `now` in units of `reference`: the root mean square of their ratios over the three velocities.
double RelativeError(const FreeRunError& now, const FreeRunError& reference);

}  // namespace telltale
