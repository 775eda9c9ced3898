#include <filesystem>
#include <iostream>
#include <memory>
#include <string_view>
#include <vector>

#include "telltale/client/cli/commands.hpp"
#include "telltale/client/cli/input_options.hpp"
#include "telltale/client/cli/number_range.hpp"
#include "telltale/client/cli/progress_line.hpp"
#include "telltale/client/cli/whole_number.hpp"
#include "telltale/client/workbench/errors.hpp"
#include "telltale/client/workbench/export_model.hpp"
#include "telltale/client/workbench/files.hpp"
#include "telltale/client/workbench/recorded_log.hpp"

namespace telltale {
namespace {

namespace fs = std::filesystem;

struct ExportArguments {
  fs::path model_file;
  fs::path vehicle_file;
  fs::path log;  ///< of csv and mcap
  SourceOptions options;
  ExportChoices choices;
};

/// csv and mcap are about a log, the others about the model alone.
void RequireFittingOptions(const ExportArguments& arguments) {
  const ExportChoices& choices = arguments.choices;
  if (choices.IsOverARecording() && arguments.log.empty()) {
    throw UsageError("--log is required with --format " + choices.format +
                     ": it shows the model over a recording");
  }
  if (!choices.IsOverARecording() && !arguments.log.empty()) {
    throw UsageError("--log goes with --format csv and mcap; " + choices.format +
                     " takes the model alone");
  }
  if (choices.IsOverARecording() && choices.draws) {
    throw UsageError("--draws goes with --format mss and vrx");
  }
}

std::vector<fs::path> Exported(const ExportArguments& arguments) {
  const Vehicle vehicle = LoadVehicle(arguments.vehicle_file);
  const Identification model = LoadModel(arguments.model_file);
  if (!arguments.choices.IsOverARecording()) {
    return ExportModel(model, vehicle, arguments.choices, PrintNote);
  }
  ProgressLine line;
  line.Update("reading the log", 0.0);
  const Recording recording = LoadAdmitted(arguments.log, arguments.options, PrintNote);
  return ExportSeries(
      model, recording, vehicle, arguments.choices,
      [&](std::string_view stage, double fraction) { line.Update(stage, fraction); }, PrintNote);
}

void PrintExported(const ExportArguments& arguments) {
  RequireFittingOptions(arguments);
  for (const fs::path& file : Exported(arguments)) std::cout << file.string() << '\n';
}

/// Of the formats over a recording, then of those of the model alone.
void AddFormatOptions(CLI::App& command, ExportChoices& choices) {
  command
      .add_option("--horizon", choices.horizon_s,
                  "of csv and mcap: length of the free runs, seconds, at least two sampling "
                  "periods, at most 600")
      ->type_name("S")
      ->check(NumberWithin(0.0, 600.0).description(""))
      ->capture_default_str();
  auto* const draws =
      command
          .add_option(
              "--draws", choices.draws,
              "of mss and vrx: also this many joint draws of the coefficients, [1, 100000], as "
              "draws.json and draws.csv; --out is then a folder")
          ->type_name("N")
          ->check(CLI::Range(1, 100000).description(""));
  command.add_option("--seed", choices.seed, "of the draws; the same seed gives the same bits")
      ->type_name("N")
      ->check(WholeNumber())
      ->capture_default_str()
      ->needs(draws);
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
          "--format", arguments->choices.format,
          "mss: M^-1-normalised coefficients for Fossen's MSS and Python Vehicle Simulator; "
          "vrx: a hydrodynamics plugin for Gazebo, which needs the vehicle's mass_kg; "
          "csv: the model over a log, as tables; "
          "mcap: the same for Foxglove and PlotJuggler")
      ->type_name("NAME")
      ->required()
      ->check(CLI::IsMember({"mss", "vrx", "csv", "mcap"}).description(""));
  AddLog(command, arguments->log, arguments->options)->required(false);
  AddFormatOptions(command, arguments->choices);
  command
      .add_option(
          "--out", arguments->choices.out,
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
  command.callback([arguments] { PrintExported(*arguments); });
}

}  // namespace telltale
