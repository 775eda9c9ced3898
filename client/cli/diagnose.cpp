#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "telltale/client/cli/commands.hpp"
#include "telltale/client/cli/diagnose_arguments.hpp"
#include "telltale/client/cli/diagnose_live.hpp"
#include "telltale/client/cli/live_options.hpp"
#include "telltale/client/cli/progress_line.hpp"
#include "telltale/client/workbench/diagnose_recorded.hpp"
#include "telltale/client/workbench/files.hpp"

namespace telltale {
namespace {

/// An id that a log alone suggests is nobody's choice, so it cannot contradict the model's.
std::string VehicleIdFor(const DiagnoseArguments& arguments, const Vehicle& vehicle,
                         const Identification& model) {
  return arguments.inputs.NamesVehicle() ? vehicle.vehicle_id : model.vehicle_id;
}

std::vector<std::string> NamesOf(const std::vector<std::filesystem::path>& logs) {
  std::vector<std::string> names;
  for (const auto& log : logs) names.push_back(NameOf(log));
  return names;
}

ReportSources SourcesOf(const DiagnoseArguments& arguments) {
  return {NamesOf(arguments.inputs.logs), NamesOf(arguments.reference_logs),
          arguments.model_file.filename().string(), std::nullopt};
}

DiagnosedModel DiagnoseFromFiles(const DiagnoseArguments& arguments) {
  arguments.choices.Options();  // a usage error need not wait for logs
  const Identification model = LoadModel(arguments.model_file);
  ProgressLine line;
  line.Update("reading logs", 0.0);
  const RecordedVehicle diagnosed = arguments.inputs.Load();
  std::vector<RecordedLog> references;
  for (const auto& log : arguments.reference_logs) {
    references.push_back(LoadLog(log, arguments.inputs.options, PrintNote));
  }
  return DiagnoseRecorded(
      model, diagnosed, std::move(references), VehicleIdFor(arguments, diagnosed.vehicle, model),
      arguments.choices,
      [&line](std::string_view stage, double fraction) { line.Update(stage, fraction); });
}

void DiagnoseLogs(const DiagnoseArguments& arguments) {
  const DiagnosedModel diagnosed = DiagnoseFromFiles(arguments);
  arguments.Write(diagnosed.diagnosis, diagnosed.augmented, SourcesOf(arguments));
}

}  // namespace

void AddDiagnose(CLI::App& telltale) {
  const auto arguments = std::make_shared<DiagnoseArguments>();
  const auto vehicle_id = std::make_shared<std::string>();
  const auto live = std::make_shared<LiveOptions>();
  CLI::App& command = *telltale.add_subcommand(
      "diagnose",
      "Finds where a model and a recording differ, which effect explains it, and how much of the "
      "excess error it explains");
  auto* const whom = command.add_option_group("from", "logs, or a vehicle the daemon follows");
  whom->require_option(1);
  auto* const log = arguments->inputs.AddTo(command, *whom);
  AddVehicleId(*whom, *vehicle_id);
  arguments->AddOptionsTo(command, log);
  live->AddTo(command, 300.0, "with --vehicle-id: how long to wait for the answer");
  command.footer(
      "Give a recording of 60 s or more that did not make the model. Errors are in times the\n"
      "normal error, 1 is what a nominal recording shows.\n"
      "Example: telltale diagnose --log today --vehicle boat.textproto --model model.json \\\n"
      "             --reference-log last-week --html report.html --out report.json\n"
      "         telltale diagnose --vehicle-id boat-1");
  command.callback([arguments, vehicle_id, live] {
    vehicle_id->empty() ? DiagnoseLogs(*arguments) : DiagnoseLive(*vehicle_id, *arguments, *live);
  });
}

}  // namespace telltale
