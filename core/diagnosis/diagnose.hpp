#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "telltale/core/base/result.hpp"
#include "telltale/core/data/prepared_dataset.hpp"
#include "telltale/core/diagnosis/report/diagnosis.hpp"
#include "telltale/core/identification/identification.hpp"
#include "telltale/core/identification/progress.hpp"

namespace telltale {

inline constexpr double kMinimumDiagnosedS = 60.0;

struct DiagnoseOptions {
  bool refit = false;  ///< let the coefficients follow the recording, as a model made from it would
  std::size_t most_effects = 3;      ///< that may act together, [1, 3]
  std::vector<std::string> without;  ///< effects to leave out of the library
  bool advise = true;
  std::uint64_t seed = 1;
  std::size_t threads = 1;  ///< [1, 256]; never changes the result

  /// The first field out of its range, as a refusal naming field, value and range.
  std::optional<Refusal> Validate() const;
};

/// A diagnosis and the model identified again with the effects it names; none where it names none.
struct DiagnosedModel {
  Diagnosis diagnosis;
  std::optional<Identification> augmented;
};

/// Where, why and how far a model parts from a recording that it was not made from,
/// docs/concepts/diagnosis.md. `references` are recordings of the same boat when all was well;
/// without any the floor is what sensor noise alone would leave, which is too low. Refuses when:
/// the model lacks an equation, the recording is shorter than kMinimumDiagnosedS, nothing in it
/// moves, model and recording are of different boats, or the thrusters seem to be swapped or
/// reversed, which it names.
Result<DiagnosedModel> Diagnose(const PreparedDataset& recording,
                                const std::vector<PreparedDataset>& references,
                                const Identification& model, const std::string& vehicle_id,
                                const DiagnoseOptions& options, const Progress& progress = {});

}  // namespace telltale
