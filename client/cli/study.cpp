#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <thread>

#include "telltale/client/cli/commands.hpp"
#include "telltale/client/cli/exit_codes.hpp"
#include "telltale/client/cli/input_options.hpp"
#include "telltale/client/cli/number_range.hpp"
#include "telltale/client/cli/output_options.hpp"
#include "telltale/client/cli/progress_line.hpp"
#include "telltale/client/cli/study_table.hpp"
#include "telltale/client/cli/whole_number.hpp"
#include "telltale/client/workbench/errors.hpp"
#include "telltale/client/workbench/presets.hpp"
#include "telltale/core/data/sampling_grid.hpp"
#include "telltale/core/paper/study.hpp"
#include "telltale/idl/codec/json/study.hpp"

namespace telltale {
namespace {

struct StudyArguments {
  LogInputs inputs;
  std::string preset = "robust";
  std::optional<double> sampling_period_s;
  StudyOptions options;
  OutputOptions output;
};

std::string Text(const Study& study) {
  std::string text = StudyTable(study);
  for (const Refusal& refusal : study.refusals) text += '\n' + Explained(refusal);
  return text;
}

void RunStudy(const StudyArguments& arguments) {
  ProgressLine line;
  line.Update("reading logs", 0.0);
  const RecordedVehicle recorded = arguments.inputs.Load();
  PrepareOptions prepare = PrepareOptionsOf(PresetNamed(arguments.preset));
  prepare.sampling_period_s = arguments.sampling_period_s;
  const PreparedDataset dataset = OrThrow(Prepare(recorded.recording, recorded.vehicle, prepare));
  StudyOptions options = arguments.options;
  options.threads = std::max(1u, std::thread::hardware_concurrency());
  const Study study =
      OrThrow(StudyRecording(dataset, options, [&](std::string_view stage, double fraction) {
        line.Update(std::string(stage), fraction);
      }));
  arguments.output.Write(PrintStudyJson(study), [&] { return Text(study); });
}

}  // namespace

void AddStudy(CLI::App& telltale) {
  const auto arguments = std::make_shared<StudyArguments>();
  CLI::App& command = *telltale.add_subcommand(
      "study", "Reruns the paper's experiments: partitions, training shares, coefficient tables");
  arguments->inputs.AddTo(command, command)->required();
  command.add_option("--preset", arguments->preset, "of the data preparation: robust or paper")
      ->type_name("NAME")
      ->check(CLI::IsMember(PresetNames()).description(""))
      ->capture_default_str();
  command
      .add_option("--sampling-period", arguments->sampling_period_s,
                  "seconds, [0.02, 2] (default: the median GNSS period)")
      ->type_name("S")
      ->check(NumberWithin(kShortestPeriodS, kLongestPeriodS).description(""));
  command
      .add_option("--partitions", arguments->options.repeats,
                  "random partitions behind each mean, [1, 1000]")
      ->type_name("N")
      ->check(CLI::Range(1, 1000).description(""))
      ->capture_default_str();
  command.add_option("--seed", arguments->options.seed, "of the partitions and the bootstrap")
      ->type_name("N")
      ->check(WholeNumber())
      ->capture_default_str();
  AddIncludeRr(command, arguments->options.include_reverse);
  arguments->output.AddTo(command, "study.json");
  command.footer(
      "MAE and RMSE are in m/s and rad/s; columns headed `paper` are the published figures.\n"
      "Example: telltale study --log run1 --log run2 --vehicle boat.textproto");
  command.callback([arguments] { RunStudy(*arguments); });
}

}  // namespace telltale
