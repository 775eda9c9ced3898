#pragma once

#include <optional>

#include "telltale/core/identification/model_comparison.hpp"
#include "telltale/service/models/model_store.hpp"

namespace telltale {

/// Whether a model differs from its predecessor: the vehicle's newest earlier model that was made
/// with the same options and, by the vehicle's clock, shares no data with it. Models of overlapping
/// windows have correlated errors, and the test assumes independent ones.
/// The change has the few most significant coefficients. It is kInconclusive where there is no such
/// predecessor, or no test of it. Nothing for a vehicle's first model.
std::optional<ModelChange> ChangeSincePredecessor(const ModelStore& store,
                                                  const Identification& identification);

}  // namespace telltale
