#include "telltale/client/workbench/score_model.hpp"

#include <utility>

#include "telltale/client/workbench/errors.hpp"
#include "telltale/client/workbench/presets.hpp"
#include "telltale/core/diagnosis/hypotheses/augmented_identification.hpp"

namespace telltale {

ModelScores ScoreModel(const Identification& model, const RecordedVehicle& recorded,
                       const std::optional<std::string>& preset, const ValidationOptions& options,
                       const Progress& progress) {
  progress("preparing data", 0.2);
  PreparedDataset dataset =
      OrThrow(Prepare(recorded.recording, recorded.vehicle, PrepareOptionsOf(model, preset)));
  progress("scoring", 0.5);
  Metrics metrics =
      OrThrow(model.physical ? Validate(dataset, *model.physical, options)
                             : Validate(dataset, OrThrow(AugmentedModelOf(model)), options));
  return {std::move(dataset), std::move(metrics)};
}

}  // namespace telltale
