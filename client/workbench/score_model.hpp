#pragma once

#include <optional>
#include <string>

#include "telltale/client/workbench/recorded_vehicle.hpp"
#include "telltale/core/data/prepared_dataset.hpp"
#include "telltale/core/identification/identification.hpp"
#include "telltale/core/identification/progress.hpp"
#include "telltale/core/validation/validation.hpp"

namespace telltale {

/// Scores, and the data that they are of.
struct ModelScores {
  PreparedDataset dataset;
  Metrics metrics;
};

/// Scores a model as it was identified, with the effects that were added to it. `preset` is of the
/// data preparation; none: the model's own. Throws: RefusedError where the model lacks an equation,
/// or Prepare or Validate refuses; UsageError for an unknown preset.
ModelScores ScoreModel(const Identification& model, const RecordedVehicle& recorded,
                       const std::optional<std::string>& preset, const ValidationOptions& options,
                       const Progress& progress);

}  // namespace telltale
