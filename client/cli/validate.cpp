#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "telltale/client/cli/commands.hpp"
#include "telltale/client/cli/input_options.hpp"
#include "telltale/client/cli/metrics_table.hpp"
#include "telltale/client/cli/number_range.hpp"
#include "telltale/client/cli/output_options.hpp"
#include "telltale/client/cli/progress_line.hpp"
#include "telltale/client/cli/table.hpp"
#include "telltale/client/exchange/disturbance_csv.hpp"
#include "telltale/client/recording/file_contents.hpp"
#include "telltale/client/workbench/errors.hpp"
#include "telltale/client/workbench/files.hpp"
#include "telltale/client/workbench/presets.hpp"
#include "telltale/client/workbench/score_model.hpp"
#include "telltale/core/base/format_number.hpp"
#include "telltale/core/data/sampling_grid.hpp"
#include "telltale/core/identification/input_gain.hpp"
#include "telltale/idl/codec/json/metrics.hpp"

namespace telltale {
namespace {

struct ValidateArguments {
  LogInputs inputs;
  std::filesystem::path model_file;
  std::optional<std::string> preset;
  std::vector<double> horizons_s;
  std::filesystem::path disturbance_file;  ///< empty: none is written
  OutputOptions output;
};

std::string NotExcitedText(const Identification& model) {
  std::string names;
  for (const Coefficient& coefficient : model.coefficients) {
    if (coefficient.status != CoefficientStatus::kNotExcited) continue;
    names.append(names.empty() ? "" : ", ").append(Name(coefficient.equation)).append(" ");
    names.append(coefficient.regressor);
  }
  if (names.empty()) return "";
  return Wrapped("Not excited when the model was made, so zero in it: " + names + ".");
}

// Clocks may begin anew at every start of a boat, so this is what times can tell and no more.
std::string OverlapText(const Identification& model, const PreparedDataset& dataset) {
  const double start_s = std::max(dataset.StartTime(), model.window.start_s);
  const double end_s = std::min(dataset.EndTime(), model.window.end_s);
  if (end_s <= start_s) {
    return Wrapped("By its clock this log is not among the data that made the model.");
  }
  return Wrapped("By its clock " + Fixed(end_s - start_s, 0) + " s of this log's " +
                 Fixed(dataset.EndTime() - dataset.StartTime(), 0) +
                 " s lie in the window that made the model: these may be scores on the model's own "
                 "data.");
}

std::string ScoredText(const PreparedDataset& dataset) {
  return Wrapped("Scored on " + Counted(dataset.rows.size(), "row", "rows") + " in " +
                 Counted(dataset.segments.size(), "segment", "segments") + " without gaps.");
}

ValidationOptions OptionsOf(const ValidateArguments& arguments, const Identification& model) {
  if (arguments.horizons_s.empty()) return UsualOptions(model.sampling_period_s);
  ValidationOptions options{arguments.horizons_s};
  const auto horizon_s = options.HorizonOutOfRange(model.sampling_period_s);
  if (!horizon_s) return options;
  throw UsageError("--horizon " + FormatSignificant(*horizon_s, 6) + " must be within [" +
                   FormatSignificant(2.0 * model.sampling_period_s, 6) + ", " +
                   FormatSignificant(kLongestHorizonS, 6) +
                   "] s, from two sampling periods of the model");
}

void ValidateModel(const ValidateArguments& arguments) {
  const Identification model = LoadModel(arguments.model_file);
  const ValidationOptions options = OptionsOf(arguments, model);
  const VesselModel vessel = OrThrow(ModelOf(model));
  ProgressLine line;
  line.Update("reading logs", 0.0);
  const RecordedVehicle recorded = arguments.inputs.Load();
  if (arguments.inputs.NamesVehicle()) NoteOtherVehicle(model, recorded.vehicle, PrintNote);
  const ModelScores scores = ScoreModel(
      model, recorded, arguments.preset, options,
      [&line](std::string_view stage, double fraction) { line.Update(stage, fraction); });
  if (!arguments.disturbance_file.empty()) {
    WriteFile(arguments.disturbance_file,
              PrintDisturbanceCsv(ReconstructDisturbance(scores.dataset, vessel)));
  }
  arguments.output.Write(PrintMetricsJson(scores.metrics), [&] {
    return MetricsTable(scores.metrics) + '\n' + ScoredText(scores.dataset) +
           NotExcitedText(model) + OverlapText(model, scores.dataset);
  });
}

}  // namespace

void AddValidate(CLI::App& telltale) {
  const auto arguments = std::make_shared<ValidateArguments>();
  CLI::App& command =
      *telltale.add_subcommand("validate", "Scores a model on a log: one step ahead and free run");
  arguments->inputs.AddTo(command, command)->required();
  AddModelFile(command, arguments->model_file);
  command
      .add_option("--horizon", arguments->horizons_s,
                  "lengths of free runs, seconds, at least two sampling periods, at most 600 "
                  "(default 1 5 10, as far as these are in the range)")
      ->type_name("S")
      ->check(NumberWithin(2.0 * kShortestPeriodS, kLongestHorizonS).description(""));
  command
      .add_option("--preset", arguments->preset,
                  "of the data preparation: robust or paper (default: the model's own)")
      ->type_name("NAME")
      ->check(CLI::IsMember(PresetNames()).description(""));
  command
      .add_option("--disturbance", arguments->disturbance_file,
                  "also write what is left of the acceleration without the propellers, over the "
                  "logs, as time_s,sigma_u,sigma_v,sigma_r")
      ->type_name("FILE.csv");
  arguments->output.AddTo(command, "metrics.json");
  command.footer(
      "Errors are in m/s and rad/s, positions in metres. Score on logs that did not make the "
      "model.\n"
      "Example: telltale validate --log run2 --vehicle boat.textproto --model model.json");
  command.callback([arguments] { ValidateModel(*arguments); });
}

}  // namespace telltale
