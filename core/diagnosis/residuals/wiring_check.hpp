#pragma once

#include <optional>

#include "telltale/core/base/result.hpp"
#include "telltale/core/data/prepared_dataset.hpp"
#include "telltale/core/identification/uncertain_model.hpp"

namespace telltale {

/// What is wrong with how commands reach the thrusters, or with the vehicle file that says so:
/// sides swapped, one or both reversed. Found when the model follows the recording far better with
/// commands exchanged or turned round.
std::optional<Refusal> SuspectedWiringFault(const PreparedDataset& recording,
                                            const VesselModel& model);

}  // namespace telltale
