#include "telltale/client/cli/identify_arguments.hpp"

#include <string>

#include "telltale/client/cli/number_pair.hpp"
#include "telltale/client/cli/whole_number.hpp"
#include "telltale/client/workbench/presets.hpp"

namespace telltale {
namespace {

void ChooseDeadZone(const std::string& text, IdentifyChoices& choices) {
  choices.identify_dead_zone = text == "identify";
  if (choices.identify_dead_zone) return;
  const auto [forward, reverse] =
      NumberPair("--dead-zone", text, "two limits as in 0.05,-0.06, or identify");
  choices.dead_zone = {forward, reverse};
}

void AddStructureOptions(CLI::App& command, IdentifyChoices& choices) {
  command
      .add_option(
          "--structure", choices.structure,
          "of the model: fossen (default), the physical form, with delays between the channels; "
          "static, the paper's free coefficients, whose thrust follows the command at once, which "
          "options that only they have choose by themselves; dynamic, the same with a first-order "
          "lag; auto: fossen, or static where it predicts data set aside well")
      ->type_name("NAME")
      ->check(CLI::IsMember(StructureNames()).description(""));
  command
      .add_option_function<std::string>(
          "--dead-zone", [&choices](const std::string& text) { ChooseDeadZone(text, choices); },
          "commands that give no thrust: two limits in shares of full command, the forward "
          "one in [0, 0.3] and the reverse one in [-0.3, 0], or identify (default 0,0)")
      ->type_name("FORWARD,REVERSE");
  command
      .add_option(
          "--parameterization", choices.parameterization,
          "of the propellers: propeller (default), consistent in all four regions, or paper")
      ->type_name("NAME")
      ->check(CLI::IsMember(ParameterizationNames()).description(""));
  AddIncludeRr(command, choices.include_rr);
}

void AddEstimatorOptions(CLI::App& command, IdentifyChoices& choices) {
  command
      .add_option(
          "--estimator", choices.estimator,
          "auto (default): output-error, the most precise, where the data show no disturbance, "
          "else weak-iv, whose bounds hold with one; or one-step, the paper's, which "
          "--preset paper and options of the bootstrap ask for")
      ->type_name("NAME")
      ->check(CLI::IsMember(EstimatorNames()).description(""));
  command
      .add_option("--preset", choices.preset, "of the data preparation: robust (default) or paper")
      ->type_name("NAME")
      ->check(CLI::IsMember(PresetNames()).description(""));
  command
      .add_option("--sampling-period", choices.sampling_period_s,
                  "of the model, seconds, [0.02, 2] (default: the median GNSS period)")
      ->type_name("S");
}

void AddBoundsOptions(CLI::App& command, IdentifyChoices& choices) {
  command
      .add_option(
          "--replicates", choices.parametric_replicates,
          "parametric bootstrap replicates behind the bounds of weak-iv, [8, 1000], 0 for none "
          "(default 40)")
      ->type_name("N")
      ->check(WholeNumber());
  command
      .add_option("--bootstrap", choices.bootstrap_replicates,
                  "replicates behind the bounds of one-step, [100, 100000], 0 for bounds from "
                  "residuals (default 1000)")
      ->type_name("N")
      ->check(WholeNumber());
  command
      .add_option("--bootstrap-kind", choices.bootstrap_kind,
                  "what a replicate redraws: slices (default), moving-blocks as long as the data "
                  "ask for, or with parametric nothing: it simulates the data anew, which is slow")
      ->type_name("NAME")
      ->check(CLI::IsMember(BootstrapKindNames()).description(""));
  command
      .add_option("--interval", choices.interval,
                  "how replicates bound: percentile (default), studentized (default of "
                  "parametric, whose bias it takes out) or bca")
      ->type_name("NAME")
      ->check(CLI::IsMember(IntervalNames()).description(""));
  command
      .add_option("--recording-bias", choices.recording_bias,
                  "constant disturbance, as of wind: shared by all logs (default of one log, of a "
                  "window, and of one-step), per-recording (default of several; in a window, what "
                  "a minute of silence separates), or per-recording-ned: with a part besides that "
                  "stands to the north and east while the boat turns")
      ->type_name("NAME")
      ->check(CLI::IsMember(RecordingBiasNames()).description(""));
  command
      .add_option("--check-coverage", choices.coverage_check_replicates,
                  "measure how often the bounds hold on so many synthetic datasets, "
                  "[10, 1000]; each takes as long as the identification itself")
      ->type_name("N")
      ->check(WholeNumber());
  command
      .add_option("--level", choices.interval_level, "of the bounds, [0.5, 0.999] (default 0.95)")
      ->type_name("P");
}

void AddRepeatabilityOptions(CLI::App& command, IdentifyChoices& choices) {
  command
      .add_option("--seed", choices.seed, "of everything random; the same seed gives the same bits")
      ->type_name("N")
      ->check(WholeNumber())
      ->capture_default_str();
  command
      .add_option("--threads", choices.threads,
                  "[1, 256] (default: all of the machine); never changes the result")
      ->type_name("N")
      ->check(WholeNumber());
}

}  // namespace

void IdentifyArguments::AddOptionsTo(CLI::App& command) {
  AddStructureOptions(command, choices);
  AddEstimatorOptions(command, choices);
  AddBoundsOptions(command, choices);
  AddRepeatabilityOptions(command, choices);
  command.add_flag("--discrete", discrete,
                   "also print the coefficients times the sampling period, as in the paper");
  output.AddTo(command, "model.json");
}

}  // namespace telltale
