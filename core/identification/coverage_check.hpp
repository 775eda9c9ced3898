#pragma once

#include "telltale/core/base/result.hpp"
#include "telltale/core/data/samples.hpp"
#include "telltale/core/identification/identification.hpp"
#include "telltale/core/identification/identify.hpp"
#include "telltale/core/vessel/vehicle.hpp"

namespace telltale {

/// Coverage check by simulation, docs/concepts/model.md (60): how often the bounds of
/// `identification` hold if its model is true. The model is simulated
/// options.coverage_check_replicates times under the recorded commands, with the disturbance and
/// sensor noise that the data show. Each replicate passes through Identify() with the same options.
/// Replicate i has seeds of its own, so results do not depend on threads. `progress` is called by
/// one thread at a time; what it throws ends the work. Refuses when: the model diverges under the
/// recorded commands, the disturbance cannot be estimated, or no replicate can be identified.
Result<CoverageCheck> CheckCoverage(const Recording& recording, const Vehicle& vehicle,
                                    const Identification& identification,
                                    const IdentifyOptions& options, const Progress& progress = {});

}  // namespace telltale
