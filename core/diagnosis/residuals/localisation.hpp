#pragma once

#include <cstdint>
#include <vector>

#include "telltale/core/data/prepared_dataset.hpp"
#include "telltale/core/diagnosis/report/diagnosis.hpp"
#include "telltale/core/effects/augmented_model.hpp"

namespace telltale {

/// Where model and boat part: by channel and, each on its own, propeller region, speed, heading,
/// time and whether commands have just changed, and region by speed.
/// Method: accelerations that the model misses by from row to row, in nominal sigmas. A cell's mean
/// is compared with that of the reference recordings; p-values by a wild bootstrap that turns the
/// signs of whole windows of five seconds, against the largest of all cells (max-T). A cell is
/// listed when its p-value is at most five per cent and it holds at least five per cent of the
/// excess; a region at one speed beside that region or speed only where its rows hold half as much
/// excess again each. docs/concepts/diagnosis.md (93), (94).
/// Requires: at least one reference.
std::vector<GapCell> Localise(const PreparedDataset& recording,
                              const std::vector<PreparedDataset>& references,
                              const AugmentedModel& boat, std::uint64_t seed);

}  // namespace telltale
