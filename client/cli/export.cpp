#include <cstdint>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <string>

#include "telltale/client/cli/commands.hpp"
#include "telltale/client/cli/input_options.hpp"
#include "telltale/client/cli/number_range.hpp"
#include "telltale/client/cli/progress_line.hpp"
#include "telltale/client/cli/whole_number.hpp"
#include "telltale/client/exchange/model_series.hpp"
#include "telltale/client/exchange/mss.hpp"
#include "telltale/client/exchange/posterior_draws.hpp"
#include "telltale/client/exchange/vrx.hpp"
#include "telltale/client/recording/file_contents.hpp"
#include "telltale/client/workbench/errors.hpp"
#include "telltale/client/workbench/files.hpp"
#include "telltale/client/workbench/presets.hpp"
#include "telltale/client/workbench/recorded_vehicle.hpp"
#include "telltale/core/data/preparation.hpp"
#include "telltale/core/diagnosis/hypotheses/augmented_identification.hpp"
#include "telltale/core/validation/validation.hpp"

namespace telltale {
namespace {

namespace fs = std::filesystem;

struct ExportArguments {
  fs::path model_file;
  fs::path vehicle_file;
  std::string format;
  fs::path log;  ///< of csv and mcap
  SourceOptions options;
  double horizon_s = 10.0;
  std::optional<std::size_t> draws;
  std::uint64_t seed = 1;
  fs::path out;

  bool IsOverALog() const { return format == "csv" || format == "mcap"; }
  const char* FileName() const { return format == "mss" ? "mss.json" : "vrx.sdf"; }
};

std::string Formatted(const ExportArguments& arguments, const Identification& model,
                      const Vehicle& vehicle) {
  return arguments.format == "mss" ? PrintMss(model, vehicle) : OrThrow(PrintVrx(model, vehicle));
}

void Write(const fs::path& file, const std::string& text) {
  WriteFile(file, text);
  std::cout << file.string() << '\n';
}

void NoteDraws(const PosteriorDraws& draws) {
  for (const std::string& name : draws.not_drawn) {
    PrintNote(name + " is not drawn: the data do not determine its variance");
  }
  if (draws.clipped > 0.0) {
    std::cerr << "note: the covariance has a negative eigenvalue, " << draws.clipped
              << " of the largest, taken as zero\n";
  }
}

void WriteDraws(const ExportArguments& arguments, const Identification& model,
                const PosteriorDraws& draws) {
  NoteDraws(draws);
  Write(arguments.out / "draws.json", PrintDrawsJson(model, draws, arguments.seed));
  Write(arguments.out / "draws.csv", PrintDrawsCsv(model, draws));
}

/// What the model says over a log, as files to write.
void ExportSeries(const ExportArguments& arguments) {
  const Vehicle vehicle = LoadVehicle(arguments.vehicle_file);
  const Identification model = LoadModel(arguments.model_file);
  NoteOtherVehicle(model, vehicle, PrintNote);
  ProgressLine line;
  line.Update("reading the log", 0.0);
  const Recording recording = LoadAdmitted(arguments.log, arguments.options, PrintNote);
  line.Update("preparing data", 0.3);
  const PreparedDataset dataset = OrThrow(Prepare(recording, vehicle, PrepareOptionsOf(model)));
  const auto runs = [&](double horizon_s) {
    return OrThrow(model.physical
                       ? FreeRunsOf(dataset, *model.physical, horizon_s)
                       : FreeRunsOf(dataset, OrThrow(AugmentedModelOf(model)), horizon_s));
  };
  line.Update("predicting", 0.6);
  const ModelSeries series{model, dataset, runs(arguments.horizon_s),
                           runs(dataset.sampling_period_s)};
  line.Update("writing", 0.9);
  if (arguments.format == "mcap") {
    const bool into_folder = fs::is_directory(arguments.out);
    Write(into_folder ? arguments.out / "model.mcap" : arguments.out, PrintSeriesMcap(series));
    return;
  }
  fs::create_directories(arguments.out);
  Write(arguments.out / "series.csv", PrintSeriesCsv(series));
  Write(arguments.out / "coefficients.csv", PrintCoefficientsCsv(model));
}

/// csv and mcap are about a log, the others about the model alone.
void RequireFittingOptions(const ExportArguments& arguments) {
  if (arguments.IsOverALog() && arguments.log.empty()) {
    throw UsageError("--log is required with --format " + arguments.format +
                     ": it shows the model over a recording");
  }
  if (!arguments.IsOverALog() && !arguments.log.empty()) {
    throw UsageError("--log goes with --format csv and mcap; " + arguments.format +
                     " takes the model alone");
  }
  if (arguments.IsOverALog() && arguments.draws) {
    throw UsageError("--draws goes with --format mss and vrx");
  }
}

// Everything that can be refused is computed before anything is written.
void ExportModel(const ExportArguments& arguments) {
  RequireFittingOptions(arguments);
  if (arguments.IsOverALog()) return ExportSeries(arguments);
  const Vehicle vehicle = LoadVehicle(arguments.vehicle_file);
  const Identification estimated = LoadModel(arguments.model_file);
  const Identification model = WithSimulationParameters(estimated);
  NoteOtherVehicle(model, vehicle, PrintNote);
  if (!estimated.simulation.empty()) {
    PrintNote(
        "as estimated the model diverges; the file and the draws take the "
        "regularised values for simulation");
  }
  const std::string text = Formatted(arguments, model, vehicle);
  std::optional<PosteriorDraws> draws;
  if (arguments.draws) draws = OrThrow(DrawFromPosterior(model, *arguments.draws, arguments.seed));
  if (draws) fs::create_directories(arguments.out);
  const bool into_folder = fs::is_directory(arguments.out);
  Write(into_folder ? arguments.out / arguments.FileName() : arguments.out, text);
  if (draws) WriteDraws(arguments, model, *draws);
}

}  // namespace

void AddExport(CLI::App& telltale) {
  const auto arguments = std::make_shared<ExportArguments>();
  CLI::App& command = *telltale.add_subcommand(
      "export",
      "Writes a model for other simulators or viewers, and draws of it for domain randomisation");
  AddModelFile(command, arguments->model_file);
  AddVehicleFile(command, arguments->vehicle_file);
  command
      .add_option(
          "--format", arguments->format,
          "mss: M^-1-normalised coefficients for Fossen's MSS and Python Vehicle Simulator; "
          "vrx: a hydrodynamics plugin for Gazebo, which needs the vehicle's mass_kg; "
          "csv: the model over a log, as tables; "
          "mcap: the same for Foxglove and PlotJuggler")
      ->type_name("NAME")
      ->required()
      ->check(CLI::IsMember({"mss", "vrx", "csv", "mcap"}).description(""));
  AddLog(command, arguments->log, arguments->options)->required(false);
  command
      .add_option("--horizon", arguments->horizon_s,
                  "of csv and mcap: length of the free runs, seconds, at least two sampling "
                  "periods, at most 600")
      ->type_name("S")
      ->check(NumberWithin(0.0, 600.0).description(""))
      ->capture_default_str();
  auto* const draws =
      command
          .add_option(
              "--draws", arguments->draws,
              "also this many joint draws of the coefficients, [1, 100000], as draws.json and "
              "draws.csv; --out is then a folder")
          ->type_name("N")
          ->check(CLI::Range(1, 100000).description(""));
  command.add_option("--seed", arguments->seed, "of the draws; the same seed gives the same bits")
      ->type_name("N")
      ->check(WholeNumber())
      ->capture_default_str()
      ->needs(draws);
  command
      .add_option(
          "--out", arguments->out,
          "file to write, or a folder, into which mss.json, vrx.sdf or model.mcap goes; with csv "
          "a folder, for series.csv and coefficients.csv")
      ->type_name("DIR|FILE")
      ->required();
  command.footer(
      "The file states which properties telemetry cannot determine.\n"
      "Example: telltale export --model model.json --vehicle boat.textproto \\\n"
      "             --format mss --draws 200 --out exported\n"
      "         telltale export --model model.json --vehicle boat.textproto \\\n"
      "             --format mcap --log run2 --out run2.mcap");
  command.callback([arguments] { ExportModel(*arguments); });
}

}  // namespace telltale
