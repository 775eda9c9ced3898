#include "telltale/client/workbench/identify_recorded.hpp"

#include <utility>

#include "telltale/client/workbench/errors.hpp"
#include "telltale/core/identification/identify.hpp"
#include "telltale/core/validation/structure_choice.hpp"

namespace telltale {
namespace {

ScoredModel IdentifyAsAsked(const RecordedVehicle& recorded, const IdentifyOptions& options,
                            const Progress& progress) {
  Identification model = OrThrow(Identify(recorded.recording, recorded.vehicle, options, progress));
  progress("scoring on the part that is held out", 0.0);
  auto score = ScoreOnHeldOutPart(recorded.recording, recorded.vehicle, model, options);
  return {std::move(model), score ? std::optional(*std::move(score)) : std::nullopt};
}

ScoredModel IdentifyByTheData(const RecordedVehicle& recorded, IdentifyOptions options,
                              const Progress& progress) {
  StructureChoice choice = ChooseStructure(recorded.recording, recorded.vehicle, options, progress);
  const Structure free_structure = std::exchange(options.regression.structure, choice.structure);
  auto model = Identify(recorded.recording, recorded.vehicle, options, progress);
  if (!model && choice.structure == Structure::kFossen) {
    choice.reason = "free coefficients, since of the physical form " + model.error().reason;
    choice.score.reset();
    options.regression.structure = free_structure;
    model = Identify(recorded.recording, recorded.vehicle, options, progress);
  }
  ScoredModel made{OrThrow(std::move(model)), std::move(choice.score)};
  made.model.provenance.structure_choice = std::move(choice.reason);
  return made;
}

}  // namespace

ScoredModel IdentifyRecorded(const RecordedVehicle& recorded, const IdentifyChoices& choices,
                             const Progress& progress) {
  const IdentifyOptions options = choices.Options(recorded.logs.size());
  ScoredModel made = choices.LeaveStructureToData() ? IdentifyByTheData(recorded, options, progress)
                                                    : IdentifyAsAsked(recorded, options, progress);
  made.model.provenance.recordings = recorded.logs;
  return made;
}

}  // namespace telltale
