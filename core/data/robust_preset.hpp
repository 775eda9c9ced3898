#pragma once

#include <vector>

#include "telltale/core/data/prepared_dataset.hpp"
#include "telltale/core/data/sampling_grid.hpp"
#include "telltale/core/data/savitzky_golay.hpp"
#include "telltale/core/data/segment_signals.hpp"
#include "telltale/core/vessel/vehicle.hpp"

namespace telltale {

/// The rows of one segment from samples on both sides: positions and headings averaged about or
/// interpolated at each grid point, displacements turned into the body frame interval by interval,
/// velocities as the slope of one Savitzky-Golay filter, commands filtered by the weights with
/// which that filter passes on accelerations.
/// Source: docs/concepts/data-preparation.md (1)..(4).
std::vector<PreparedRow> PrepareRobustly(const SegmentSignals& signals, const SamplingGrid& grid,
                                         const LeverArm& antenna, const SavitzkyGolay& filter);

}  // namespace telltale
