#pragma once

#include "telltale/core/data/prepared_dataset.hpp"
#include "telltale/core/identification/identification.hpp"

namespace telltale {

/// Bounds may hold about estimates that nobody can sail. Where free runs over the model's own
/// recording run away, docs/concepts/model.md (18a), coefficients to sail with are sought that the
/// bounds or the ellipsoid hold, (18b), and written to `sailed`; a refusal says so, or that there
/// are none. Estimates and bounds stay as they are. The paper's one-step model is warned of and
/// left as the paper makes it.
void FindSimulationParameters(const PreparedDataset& dataset, Identification& identification);

}  // namespace telltale
