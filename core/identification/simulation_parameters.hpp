#pragma once

#include "telltale/core/data/prepared_dataset.hpp"
#include "telltale/core/identification/identification.hpp"

namespace telltale {

/// Finds simulation parameters. Bounds may hold although simulations with the estimates diverge,
/// docs/concepts/model.md (18a). Where free runs over the model's own recording diverge,
/// regularised coefficients within the ellipsoid or the bounds are sought, (18b), and written to
/// `simulation`. A refusal reports them, or that there are none. Estimates and bounds stay
/// unchanged. The paper's one-step model gets the refusal alone.
void FindSimulationParameters(const PreparedDataset& dataset, Identification& identification);

}  // namespace telltale
