#pragma once

#include <optional>

#include "telltale/core/identification/model_comparison.hpp"
#include "telltale/service/models/model_store.hpp"

namespace telltale {

/// Whether a model about to be published differs from the vehicle's newest earlier one that was
/// made alike and, by the boat's clock, shares no data with it: models of overlapping windows err
/// together, and no test of independent models is true of them. The few most significant
/// coefficients alone. kInconclusive where there is no such model or no test of it. Nothing for a
/// vehicle's first model.
std::optional<ModelChange> ChangeSincePredecessor(const ModelStore& store,
                                                  const Identification& identification);

}  // namespace telltale
