#pragma once

#include <optional>

#include "telltale/client/workbench/identify_choices.hpp"
#include "telltale/client/workbench/recorded_vehicle.hpp"
#include "telltale/core/identification/identification.hpp"
#include "telltale/core/identification/progress.hpp"
#include "telltale/core/validation/held_out_score.hpp"

namespace telltale {

/// A model, and what it predicts of data set aside: nothing where the recording gives no score.
struct ScoredModel {
  Identification model;
  std::optional<HeldOutScore> score;
};

/// Identifies a model, which names the logs that made it. Where the choices leave the structure to
/// the data, it is ChooseStructure's, and free coefficients where the physical form is refused.
/// Throws: UsageError as IdentifyChoices::Options, RefusedError where Identify refuses.
ScoredModel IdentifyRecorded(const RecordedVehicle& recorded, const IdentifyChoices& choices,
                             const Progress& progress);

}  // namespace telltale
