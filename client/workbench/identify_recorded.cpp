#include "telltale/client/workbench/identify_recorded.hpp"

#include "telltale/client/workbench/errors.hpp"

namespace telltale {

ScoredModel IdentifyRecorded(const RecordedVehicle& recorded, const IdentifyChoices& choices,
                             const Progress& progress) {
  const auto identify =
      choices.LeaveStructureToData() ? IdentifyInChosenStructure : IdentifyInGivenStructure;
  ScoredModel made = OrThrow(identify(recorded.recording, recorded.vehicle,
                                      choices.Options(recorded.logs.size()), progress));
  made.model.provenance.recordings = recorded.logs;
  return made;
}

}  // namespace telltale
