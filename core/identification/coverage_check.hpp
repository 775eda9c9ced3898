#pragma once

#include "telltale/core/base/result.hpp"
#include "telltale/core/data/samples.hpp"
#include "telltale/core/identification/identification.hpp"
#include "telltale/core/identification/identify.hpp"
#include "telltale/core/vessel/vehicle.hpp"

namespace telltale {

/// Measures how often the bounds of `identification` hold, docs/concepts/model.md (60): the
/// identified boat is sailed anew options.coverage_check_replicates times under the recorded
/// commands, disturbed and measured as the data show, and every repeat goes the whole way of
/// Identify with the same options. The truth is then known; the coverage is that of the bounds if
/// the model were true. Repeat i has seeds of its own, so results do not depend on threads.
/// progress is called by one thread at a time, and what it throws ends the work. Refuses when: the
/// model cannot be sailed under the recorded commands, what disturbs the boat cannot be judged, or
/// not one repeat can be identified.
Result<CoverageCheck> CheckCoverage(const Recording& recording, const Vehicle& vehicle,
                                    const Identification& identification,
                                    const IdentifyOptions& options, const Progress& progress = {});

}  // namespace telltale
