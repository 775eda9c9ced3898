#pragma once

#include <vector>

#include "telltale/core/data/prepared_dataset.hpp"
#include "telltale/core/data/sampling_grid.hpp"
#include "telltale/core/data/savitzky_golay.hpp"
#include "telltale/core/data/segment_signals.hpp"
#include "telltale/core/vessel/vehicle.hpp"

namespace telltale {

/// The rows of one segment as the paper prepares them, causally: positions, headings and commands
/// extrapolated from the newest past samples (cubic, 8th degree, cubic), velocities by central
/// differences, then smoothed.
/// Source: the paper, Data Preparation; docs/concepts/data-preparation.md.
std::vector<PreparedRow> PrepareAsPaper(const SegmentSignals& signals, const SamplingGrid& grid,
                                        const LeverArm& antenna, const SavitzkyGolay& filter);

}  // namespace telltale
