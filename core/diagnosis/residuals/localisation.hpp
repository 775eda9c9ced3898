#pragma once

#include <cstdint>
#include <vector>

#include "telltale/core/data/prepared_dataset.hpp"
#include "telltale/core/diagnosis/diagnosis.hpp"
#include "telltale/core/effects/augmented_model.hpp"

namespace telltale {

/// The operating conditions in which the model no longer matches the boat, by channel: propeller
/// region, speed, heading, third of the recording, after a step or not, and region by speed.
/// Method: acceleration residuals from row to row. The mean of a cell is compared with that of the
/// references. Its p-value is of a bootstrap that turns the signs of whole clusters, against the
/// largest statistic of all cells (max-T), so that it is family-wise. A cell is listed when its
/// p-value and its share of the excess pass the limits of LocalisationConstants. A region at one
/// speed stands beside that region or that speed only where its rows hold more excess each.
/// docs/concepts/diagnosis.md (93), (94). Units: means in root mean squares of the references.
/// The same seed gives the same cells.
/// Requires: at least one reference.
std::vector<GapCell> Localise(const PreparedDataset& recording,
                              const std::vector<PreparedDataset>& references,
                              const AugmentedModel& boat, std::uint64_t seed);

}  // namespace telltale
