#pragma once

#include <optional>

#include "telltale/core/data/prepared_dataset.hpp"
#include "telltale/core/diagnosis/uncertain_model.hpp"
#include "telltale/core/result.hpp"

namespace telltale {

/// What is wrong with how commands reach the thrusters, or with the vehicle file that says so:
/// sides swapped, one or both reversed. Found when the model follows the recording far better with
/// commands exchanged or turned round.
std::optional<Refusal> MisWired(const PreparedDataset& recording, const VesselModel& model);

}  // namespace telltale
