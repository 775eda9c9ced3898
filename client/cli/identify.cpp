#include <memory>
#include <string>
#include <string_view>

#include "telltale/client/cli/commands.hpp"
#include "telltale/client/cli/discrete_table.hpp"
#include "telltale/client/cli/identify_arguments.hpp"
#include "telltale/client/cli/identify_live.hpp"
#include "telltale/client/cli/live_options.hpp"
#include "telltale/client/cli/model_table.hpp"
#include "telltale/client/cli/progress_line.hpp"
#include "telltale/client/workbench/identify_recorded.hpp"
#include "telltale/idl/codec/json/model.hpp"

namespace telltale {
namespace {

RecordedVehicle LoadLogs(const IdentifyArguments& arguments) {
  ProgressLine line;
  line.Update("reading logs", 0.0);
  return arguments.inputs.Load();
}

void IdentifyLogs(const IdentifyArguments& arguments) {
  const IdentifyChoices& choices = arguments.choices;
  choices.Options(arguments.inputs.logs.size());  // a usage error need not wait for logs
  const RecordedVehicle recorded = LoadLogs(arguments);
  const ScoredModel made = [&] {
    ProgressLine line;
    return IdentifyRecorded(recorded, choices, [&line](std::string_view stage, double fraction) {
      line.Update(stage, fraction);
    });
  }();
  arguments.output.Write(PrintModelJson(made.model), [&] {
    return ModelTable(made.model, made.score) +
           (arguments.discrete ? '\n' + DiscreteTable(made.model) : "");
  });
}

}  // namespace

void AddIdentify(CLI::App& telltale) {
  const auto arguments = std::make_shared<IdentifyArguments>();
  const auto vehicle_id = std::make_shared<std::string>();
  const auto live = std::make_shared<LiveOptions>();
  CLI::App& command = *telltale.add_subcommand(
      "identify",
      "Identifies a vehicle's model, with bounds, from logs or from the daemon's window");
  auto* const whom = command.add_option_group("from", "logs, or a vehicle the daemon follows");
  whom->require_option(1);
  arguments->inputs.AddTo(command, *whom);
  arguments->inputs.AddInputCheckTo(command);
  AddVehicleId(*whom, *vehicle_id);
  arguments->AddOptionsTo(command);
  live->AddTo(command, 120.0,
              "with --vehicle-id: how long to wait for the answer, and as long again for every "
              "ten replicates of a coverage check");
  command.footer(
      "Coefficients are continuous-time, SI.\n"
      "Example: telltale identify --log run1 --log run2 --vehicle boat.textproto --out model.json\n"
      "         telltale identify --log 00000042.BIN --out model.json\n"
      "         telltale identify --vehicle-id boat-1");
  command.callback([arguments, vehicle_id, live] {
    vehicle_id->empty() ? IdentifyLogs(*arguments) : IdentifyLive(*vehicle_id, *arguments, *live);
  });
}

}  // namespace telltale
