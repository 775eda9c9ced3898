#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "telltale/core/base/result.hpp"
#include "telltale/core/data/prepared_dataset.hpp"
#include "telltale/core/diagnosis/diagnosis.hpp"
#include "telltale/core/diagnosis/diagnosis_constants.hpp"
#include "telltale/core/identification/identification.hpp"
#include "telltale/core/identification/progress.hpp"

namespace telltale {

inline constexpr double kMinimumDiagnosedS = kDiagnosis.recording.minimum_duration_s;

struct DiagnoseOptions {
  bool refit = false;  ///< let the coefficients follow the recording, as a model made from it would
  std::size_t most_effects = 3;      ///< that may act together, [1, 3]
  std::vector<std::string> without;  ///< names of effects to leave out of the library
  bool advise = true;                ///< manoeuvres that separate equivalent hypotheses
  bool state_power = true;           ///< the sizes from which on effects show
  /// Say what a diagnosis without each reference would answer, where there are two or more: takes
  /// about a third as long as the rest, each.
  bool leave_out_references = false;
  /// Names of the references in their order; those without a name are numbered from 1.
  std::vector<std::string> reference_names;
  std::uint64_t seed = 1;   ///< of every random draw
  std::size_t threads = 1;  ///< [1, 256]; never changes the result

  /// The first field out of its range, as a refusal naming field, value and range.
  std::optional<Refusal> Validate() const;
};

/// A diagnosis, and the model identified again with the effects that it names; none where no cause
/// is likely.
struct DiagnosedModel {
  Diagnosis diagnosis;
  std::optional<Identification> augmented;
};

/// Where, why and by how much a model no longer matches the boat on a recording that it was not
/// made from, docs/concepts/diagnosis.md. `references` are recordings of the same boat in its
/// normal condition. Without any, simulated ones stand in, whose noise floor is too low. Assumes:
/// recording and references are of one boat, on their own clocks, in SI units. Refuses when: an
/// option is out of range, the model lacks an equation, recording and model are of different
/// vehicles, the recording is shorter than kMinimumDiagnosedS or has too few windows, the boat is
/// at rest throughout, the thrusters seem to be swapped or reversed, or there is no reference and
/// the model diverges on the recording.
Result<DiagnosedModel> Diagnose(const PreparedDataset& recording,
                                const std::vector<PreparedDataset>& references,
                                const Identification& model, const std::string& vehicle_id,
                                const DiagnoseOptions& options, const Progress& progress = {});

}  // namespace telltale
