#include "telltale/client/workbench/identify_recorded.hpp"

#include <utility>

#include "telltale/client/workbench/errors.hpp"
#include "telltale/core/identification/identify.hpp"

namespace telltale {
namespace {

ScoredModel IdentifyAsAsked(const RecordedVehicle& recorded, const IdentifyOptions& options,
                            const Progress& progress) {
  Identification model = OrThrow(Identify(recorded.recording, recorded.vehicle, options, progress));
  progress("scoring on the part that is held out", 0.0);
  auto score = ScoreOnHeldOutPart(recorded.recording, recorded.vehicle, model, options);
  return {std::move(model), score ? std::optional(*std::move(score)) : std::nullopt};
}

}  // namespace

ScoredModel IdentifyRecorded(const RecordedVehicle& recorded, const IdentifyChoices& choices,
                             const Progress& progress) {
  const IdentifyOptions options = choices.Options(recorded.logs.size());
  ScoredModel made = choices.LeaveStructureToData()
                         ? OrThrow(IdentifyInChosenStructure(recorded.recording, recorded.vehicle,
                                                             options, progress))
                         : IdentifyAsAsked(recorded, options, progress);
  made.model.provenance.recordings = recorded.logs;
  return made;
}

}  // namespace telltale
