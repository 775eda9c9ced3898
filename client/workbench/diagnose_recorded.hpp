#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "telltale/client/workbench/recorded_log.hpp"
#include "telltale/client/workbench/recorded_vehicle.hpp"
#include "telltale/core/diagnosis/diagnose.hpp"
#include "telltale/core/identification/identification.hpp"
#include "telltale/core/identification/progress.hpp"

namespace telltale {

/// How to diagnose, in the words of a user.
struct DiagnoseChoices {
  bool refit = false;                ///< as of DiagnoseOptions
  std::vector<std::string> without;  ///< names of effects
  std::uint64_t seed = 1;
  std::optional<std::size_t> threads;  ///< unset: all of the machine
  bool skip_influence = false;         ///< do not diagnose without each reference

  /// Throws: UsageError for a value out of its range or an effect that there is not.
  DiagnoseOptions Options() const;
};

/// What is wrong with the name of an effect: that there is none such, and which there are. Empty
/// where nothing is.
std::string EffectFault(const std::string& name);

/// Diagnoses a model on a recording. `references` are logs of the same boat in its nominal state,
/// `vehicle_id` is the boat that the recording is said to be of. The notes of the diagnosis say
/// what the recordings that made the model mean for it; the model with effects names all that made
/// it. Throws: UsageError as DiagnoseChoices::Options; RefusedError where a reference made the
/// model, is given twice or holds the recording to diagnose, or where Prepare or Diagnose refuses.
DiagnosedModel DiagnoseRecorded(const Identification& model, const RecordedVehicle& diagnosed,
                                std::vector<RecordedLog> references, const std::string& vehicle_id,
                                const DiagnoseChoices& choices, const Progress& progress);

}  // namespace telltale
