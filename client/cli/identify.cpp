#include "telltale/core/identification/identify.hpp"

#include <memory>
#include <optional>
#include <utility>

#include "telltale/client/cli/commands.hpp"
#include "telltale/client/cli/discrete_table.hpp"
#include "telltale/client/cli/exit_codes.hpp"
#include "telltale/client/cli/identify_arguments.hpp"
#include "telltale/client/cli/identify_live.hpp"
#include "telltale/client/cli/live_options.hpp"
#include "telltale/client/cli/model_table.hpp"
#include "telltale/client/cli/progress_line.hpp"
#include "telltale/core/validation/held_out_score.hpp"
#include "telltale/core/validation/structure_choice.hpp"
#include "telltale/idl/codec/json/model.hpp"

namespace telltale {
namespace {

RecordedVehicle LoadLogs(const IdentifyArguments& arguments) {
  ProgressLine line;
  line.Update("reading logs", 0.0);
  return arguments.inputs.Load();
}

/// A model, and what it predicts of data set aside: nothing where the recording gives no score; the
/// table says then how to get one.
struct ScoredModel {
  Identification model;
  std::optional<HeldOutScore> score;
};

ScoredModel IdentifyAsAsked(const RecordedVehicle& recorded, const IdentifyOptions& options,
                            const Progress& progress) {
  Identification model = OrThrow(Identify(recorded.recording, recorded.vehicle, options, progress));
  progress("scoring on the part that is held out", 0.0);
  auto score = ScoreOnHeldOutPart(recorded.recording, recorded.vehicle, model, options);
  return {std::move(model), score ? std::optional(*std::move(score)) : std::nullopt};
}

ScoredModel IdentifyByTheData(const RecordedVehicle& recorded, IdentifyOptions options,
                              const Progress& progress) {
  StructureChoice choice = ChooseStructure(recorded.recording, recorded.vehicle, options, progress);
  const Structure free_structure = std::exchange(options.regression.structure, choice.structure);
  auto model = Identify(recorded.recording, recorded.vehicle, options, progress);
  if (!model && choice.structure == Structure::kFossen) {
    choice.reason = "free coefficients, since of the physical form " + model.error().reason;
    choice.score.reset();
    options.regression.structure = free_structure;
    model = Identify(recorded.recording, recorded.vehicle, options, progress);
  }
  ScoredModel made{OrThrow(std::move(model)), std::move(choice.score)};
  made.model.provenance.structure_choice = std::move(choice.reason);
  return made;
}

void IdentifyLogs(const IdentifyArguments& arguments) {
  const IdentifyOptions options = arguments.Options();
  const RecordedVehicle recorded = LoadLogs(arguments);
  ScoredModel made = [&] {
    ProgressLine line;
    const Progress show = [&line](std::string_view stage, double fraction) {
      line.Update(stage, fraction);
    };
    return arguments.LeaveStructureToData() ? IdentifyByTheData(recorded, options, show)
                                            : IdentifyAsAsked(recorded, options, show);
  }();
  made.model.provenance.recordings = recorded.logs;
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
