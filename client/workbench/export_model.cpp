#include "telltale/client/workbench/export_model.hpp"

#include "telltale/client/exchange/model_series.hpp"
#include "telltale/client/exchange/mss.hpp"
#include "telltale/client/exchange/posterior_draws.hpp"
#include "telltale/client/exchange/shortest_number.hpp"
#include "telltale/client/exchange/vrx.hpp"
#include "telltale/client/recording/file_contents.hpp"
#include "telltale/client/workbench/errors.hpp"
#include "telltale/client/workbench/presets.hpp"
#include "telltale/client/workbench/recorded_vehicle.hpp"
#include "telltale/core/base/contract.hpp"
#include "telltale/core/data/preparation.hpp"
#include "telltale/core/diagnosis/hypotheses/augmented_identification.hpp"
#include "telltale/core/validation/validation.hpp"

namespace telltale {
namespace {

namespace fs = std::filesystem;

/// Files as they are written.
class Written {
 public:
  void Write(const fs::path& file, const std::string& text) {
    WriteFile(file, text);
    files_.push_back(file);
  }
  std::vector<fs::path> Files() && { return std::move(files_); }

 private:
  std::vector<fs::path> files_;
};

void MakeFolder(const fs::path& folder) {
  if (fs::exists(folder) && !fs::is_directory(folder)) {
    throw UsageError("--out: " + folder.string() + " is a file; give a folder");
  }
  fs::create_directories(folder);
}

/// What ends in a slash is to be a folder, there or not.
fs::path InFolder(const fs::path& out, const char* name) {
  if (!out.has_filename()) MakeFolder(out);
  return fs::is_directory(out) ? out / name : out;
}

void NoteDraws(const PosteriorDraws& draws, const NoteSink& note) {
  for (const std::string& name : draws.not_drawn) {
    note(name + " is not drawn: the data do not determine its variance");
  }
  if (draws.clipped > 0.0) {
    note("the covariance has a negative eigenvalue, " + ShortestNumber(draws.clipped) +
         " of the largest, taken as zero");
  }
}

}  // namespace

std::vector<fs::path> ExportModel(const Identification& estimated, const Vehicle& vehicle,
                                  const ExportChoices& choices, const NoteSink& note) {
  const bool is_mss = choices.format == "mss";
  Require(is_mss || choices.format == "vrx", "a format that takes the model alone");
  const Identification model = WithSimulationParameters(estimated);
  NoteOtherVehicle(model, vehicle, note);
  if (!estimated.simulation.empty()) {
    note(
        "as estimated the model diverges; the file and the draws take the "
        "regularised values for simulation");
  }
  const std::string text = is_mss ? PrintMss(model, vehicle) : OrThrow(PrintVrx(model, vehicle));
  std::optional<PosteriorDraws> draws;
  if (choices.draws) draws = OrThrow(DrawFromPosterior(model, *choices.draws, choices.seed));
  if (draws) MakeFolder(choices.out);
  Written written;
  written.Write(InFolder(choices.out, is_mss ? "mss.json" : "vrx.sdf"), text);
  if (draws) {
    NoteDraws(*draws, note);
    written.Write(choices.out / "draws.json", PrintDrawsJson(model, *draws, choices.seed));
    written.Write(choices.out / "draws.csv", PrintDrawsCsv(model, *draws));
  }
  return std::move(written).Files();
}

std::vector<fs::path> ExportSeries(const Identification& model, const Recording& recording,
                                   const Vehicle& vehicle, const ExportChoices& choices,
                                   const Progress& progress, const NoteSink& note) {
  Require(choices.IsOverARecording(), "a format that shows the model over a recording");
  const auto tell = [&](const char* stage, double fraction) {
    if (progress) progress(stage, fraction);
  };
  NoteOtherVehicle(model, vehicle, note);
  tell("preparing data", 0.3);
  const PreparedDataset dataset = OrThrow(Prepare(recording, vehicle, PrepareOptionsOf(model)));
  const auto runs = [&](double horizon_s) {
    return OrThrow(model.physical
                       ? FreeRunsOf(dataset, *model.physical, horizon_s)
                       : FreeRunsOf(dataset, OrThrow(AugmentedModelOf(model)), horizon_s));
  };
  tell("predicting", 0.6);
  const ModelSeries series{model, dataset, runs(choices.horizon_s),
                           runs(dataset.sampling_period_s)};
  tell("writing", 0.9);
  Written written;
  if (choices.format == "mcap") {
    written.Write(InFolder(choices.out, "model.mcap"), PrintSeriesMcap(series));
  } else {
    MakeFolder(choices.out);
    written.Write(choices.out / "series.csv", PrintSeriesCsv(series));
    written.Write(choices.out / "coefficients.csv", PrintCoefficientsCsv(model));
  }
  return std::move(written).Files();
}

}  // namespace telltale
