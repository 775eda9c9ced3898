#include <cstdint>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <string>

#include "telltale/client/cli/commands.hpp"
#include "telltale/client/cli/exit_codes.hpp"
#include "telltale/client/cli/input_options.hpp"
#include "telltale/client/cli/whole_number.hpp"
#include "telltale/client/exchange/mss.hpp"
#include "telltale/client/exchange/posterior_draws.hpp"
#include "telltale/client/exchange/vrx.hpp"
#include "telltale/client/recording/file_contents.hpp"

namespace telltale {
namespace {

namespace fs = std::filesystem;

struct ExportArguments {
  fs::path model_file;
  fs::path vehicle_file;
  std::string format;
  std::optional<std::size_t> draws;
  std::uint64_t seed = 1;
  fs::path out;

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
    std::cerr << "note: " << name << " is not drawn: the data do not determine its variance\n";
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

// Everything that can be refused is computed before anything is written.
void ExportModel(const ExportArguments& arguments) {
  const Vehicle vehicle = LoadVehicle(arguments.vehicle_file);
  const Identification estimated = LoadModel(arguments.model_file);
  const Identification model = WithSimulationParameters(estimated);
  NoteOtherVehicle(model, vehicle);
  if (!estimated.simulation.empty()) {
    std::cerr << "note: as estimated the model diverges; the file and the draws take the "
                 "regularised values for simulation\n";
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
      "export", "Writes a model for other simulators, and draws of it for domain randomisation");
  AddModelFile(command, arguments->model_file);
  AddVehicleFile(command, arguments->vehicle_file);
  command
      .add_option(
          "--format", arguments->format,
          "mss: M^-1-normalised coefficients for Fossen's MSS and Python Vehicle Simulator; "
          "vrx: a hydrodynamics plugin for Gazebo, which needs the vehicle's mass_kg")
      ->type_name("NAME")
      ->required()
      ->check(CLI::IsMember({"mss", "vrx"}).description(""));
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
      .add_option("--out", arguments->out,
                  "file to write, or a folder, into which mss.json or vrx.sdf goes")
      ->type_name("DIR|FILE")
      ->required();
  command.footer(
      "The file states which properties telemetry cannot determine.\n"
      "Example: telltale export --model model.json --vehicle boat.textproto --format mss "
      "--draws 200 --out exported");
  command.callback([arguments] { ExportModel(*arguments); });
}

}  // namespace telltale
