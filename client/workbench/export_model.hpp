#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "telltale/client/workbench/note_sink.hpp"
#include "telltale/core/data/samples.hpp"
#include "telltale/core/identification/identification.hpp"
#include "telltale/core/identification/progress.hpp"
#include "telltale/core/vessel/vehicle.hpp"

namespace telltale {

/// What an export is to be.
struct ExportChoices {
  std::string format;                ///< "mss", "vrx", "csv" or "mcap"
  double horizon_s = 10.0;           ///< of the free runs of csv and mcap
  std::optional<std::size_t> draws;  ///< beside mss and vrx, [1, 100000]
  std::uint64_t seed = 1;            ///< of the draws
  std::filesystem::path out;         ///< a file or a folder; of csv and of draws a folder

  /// Whether the format shows the model over a recording; the others take the model alone.
  bool IsOverARecording() const { return format == "csv" || format == "mcap"; }
};

/// Writes a model as mss or vrx, and draws of it, with the values that simulations use. Everything
/// that can be refused is computed before anything is written. Returns the files.
/// Throws: RefusedError where the format or the draws refuse; std::system_error naming the file
/// that cannot be written. Requires: a format that takes the model alone.
std::vector<std::filesystem::path> ExportModel(const Identification& estimated,
                                               const Vehicle& vehicle, const ExportChoices& choices,
                                               const NoteSink& note);

/// Writes a model over a recording, as csv or mcap: what was measured, free runs and residuals.
/// Returns the files. Throws: RefusedError where the recording cannot be prepared or predicted;
/// std::system_error. Requires: a format that shows the model over a recording.
std::vector<std::filesystem::path> ExportSeries(const Identification& model,
                                                const Recording& recording, const Vehicle& vehicle,
                                                const ExportChoices& choices,
                                                const Progress& progress, const NoteSink& note);

}  // namespace telltale
