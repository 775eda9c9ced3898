#pragma once

#include "telltale/client/workbench/identify_choices.hpp"
#include "telltale/client/workbench/recorded_vehicle.hpp"
#include "telltale/core/identification/progress.hpp"
#include "telltale/core/validation/structure_choice.hpp"

namespace telltale {

/// Identifies a model, which names the logs that made it. Where the choices leave the structure to
/// the data, it is that of IdentifyInChosenStructure.
/// Throws: UsageError as IdentifyChoices::Options, RefusedError where Identify refuses.
ScoredModel IdentifyRecorded(const RecordedVehicle& recorded, const IdentifyChoices& choices,
                             const Progress& progress);

}  // namespace telltale
