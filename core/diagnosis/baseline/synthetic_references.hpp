#pragma once

#include <cstdint>
#include <vector>

#include "telltale/core/data/prepared_dataset.hpp"
#include "telltale/core/vessel/vessel_model.hpp"

namespace telltale {

/// Recordings that stand in for references where there are none: the model, simulated with the
/// recording's commands and sensor noise. The noise floor that they give is a lower bound, since a
/// real boat differs from its model and meets weather. A simulation that diverges is left out, so
/// that there may be none. Random streams: seed, seed + 1, and so on.
std::vector<PreparedDataset> SyntheticReferences(const PreparedDataset& recording,
                                                 const VesselModel& model, std::uint64_t seed);

}  // namespace telltale
