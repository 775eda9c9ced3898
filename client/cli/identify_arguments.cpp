#include "telltale/client/cli/identify_arguments.hpp"

#include <string_view>
#include <utility>

#include "telltale/client/cli/default_threads.hpp"
#include "telltale/client/cli/exit_codes.hpp"
#include "telltale/client/cli/number_pair.hpp"
#include "telltale/client/cli/whole_number.hpp"

namespace telltale {
namespace {

DeadZone DeadZoneNamed(const std::string& text) {
  const auto [forward, reverse] =
      NumberPair("--dead-zone", text, "two limits as in 0.05,-0.06, or identify");
  return {forward, reverse};
}

/// With the options that were typed in place of the fields that they set.
std::string WithOptionNames(std::string text) {
  constexpr std::pair<std::string_view, std::string_view> kOptionNames[] = {
      {"coverage_check_replicates", "--check-coverage"},
      {"parametric_replicates", "--replicates"},
      {"bootstrap_replicates", "--bootstrap"},
      {"sampling_period_s", "--sampling-period"},
      {"interval_level", "--level"},
      {"threads", "--threads"}};
  for (const auto& [field, option] : kOptionNames) {
    const auto sets = std::string(field) + " ";  // "FIELD = 3 must be", "set FIELD to a value"
    if (!text.starts_with("identification: " + sets) &&
        !text.starts_with("data preparation: " + sets)) {
      continue;
    }
    for (auto at = text.find(sets); at != std::string::npos;
         at = text.find(sets, at + option.size())) {
      text.replace(at, field.size(), option);
    }
    break;
  }
  return text;
}

}  // namespace

void IdentifyArguments::AddOptionsTo(CLI::App& command) {
  command
      .add_option(
          "--structure", structure,
          "of the model: fossen, the physical form, with delays between the channels; static, the "
          "paper's free coefficients, whose thrust follows the command at once; dynamic, the same "
          "with a first-order lag; auto (default): fossen or static, whichever predicts data set "
          "aside better, and static with options that only it has")
      ->type_name("NAME")
      ->check(CLI::IsMember({"auto", "static", "dynamic", "fossen"}).description(""));
  command
      .add_option("--dead-zone", dead_zone,
                  "commands that give no thrust: two limits in shares of full command, the forward "
                  "one in [0, 0.3] and the reverse one in [-0.3, 0], or identify (default 0,0)")
      ->type_name("FORWARD,REVERSE");
  command
      .add_option(
          "--parameterization", parameterization,
          "of the propellers: propeller (default), consistent in all four regions, or paper")
      ->type_name("NAME")
      ->check(CLI::IsMember({"propeller", "paper"}).description(""));
  AddIncludeRr(command, include_rr);
  command
      .add_option(
          "--estimator", estimator,
          "auto (default): output-error, the most precise, where the data show no disturbance, "
          "else weak-iv, whose bounds hold with one; or one-step, the paper's, which "
          "--preset paper and options of the bootstrap ask for")
      ->type_name("NAME")
      ->check(CLI::IsMember({"auto", "one-step", "weak-iv", "output-error"}).description(""));
  command.add_option("--preset", preset, "of the data preparation: robust (default) or paper")
      ->type_name("NAME")
      ->check(CLI::IsMember({"robust", "paper"}).description(""));
  command
      .add_option("--sampling-period", sampling_period_s,
                  "of the model, seconds, [0.02, 2] (default: the median GNSS period)")
      ->type_name("S");
  command
      .add_option(
          "--replicates", parametric_replicates,
          "parametric bootstrap replicates behind the bounds of weak-iv, [8, 1000], 0 for none "
          "(default 40)")
      ->type_name("N")
      ->check(WholeNumber());
  command
      .add_option("--bootstrap", bootstrap_replicates,
                  "replicates behind the bounds of one-step, [100, 100000], 0 for bounds from "
                  "residuals (default 1000)")
      ->type_name("N")
      ->check(WholeNumber());
  command
      .add_option("--bootstrap-kind", bootstrap_kind,
                  "what a replicate redraws: slices (default), moving-blocks as long as the data "
                  "ask for, or with parametric nothing: it simulates the data anew, which is slow")
      ->type_name("NAME")
      ->check(CLI::IsMember({"slices", "moving-blocks", "parametric"}).description(""));
  command
      .add_option("--interval", interval,
                  "how replicates bound: percentile (default), studentized (default of "
                  "parametric, whose bias it takes out) or bca")
      ->type_name("NAME")
      ->check(CLI::IsMember({"percentile", "studentized", "bca"}).description(""));
  command
      .add_option("--recording-bias", recording_bias,
                  "constant disturbance, as of wind: shared by all logs (default of one log, of a "
                  "window, and of one-step), per-recording (default of several; in a window, what "
                  "a minute of silence separates), or per-recording-ned: with a part besides that "
                  "stands to the north and east while the boat turns")
      ->type_name("NAME")
      ->check(CLI::IsMember({"shared", "per-recording", "per-recording-ned"}).description(""));
  command
      .add_option("--check-coverage", coverage_check_replicates,
                  "measure how often the bounds hold on so many synthetic datasets, "
                  "[10, 1000]; each takes as long as the identification itself")
      ->type_name("N")
      ->check(WholeNumber());
  command.add_option("--level", interval_level, "of the bounds, [0.5, 0.999] (default 0.95)")
      ->type_name("P");
  command.add_option("--seed", seed, "of everything random; the same seed gives the same bits")
      ->type_name("N")
      ->check(WholeNumber())
      ->capture_default_str();
  command
      .add_option("--threads", threads,
                  "[1, 256] (default: all of the machine); never changes the result")
      ->type_name("N")
      ->check(WholeNumber());
  command.add_flag("--discrete", discrete,
                   "also print the coefficients times the sampling period, as in the paper");
  output.AddTo(command, "model.json");
}

bool IdentifyArguments::AskForBootstrap() const {
  return bootstrap_replicates || bootstrap_kind || interval;
}

std::optional<std::string_view> IdentifyArguments::OptionOfFreeCoefficients() const {
  const std::pair<bool, std::string_view> others[] = {
      {parameterization.has_value(), "--parameterization"},
      {dead_zone.has_value(), "--dead-zone"},
      {estimator.has_value() && *estimator != "auto", "--estimator"},
      {parametric_replicates.has_value(), "--replicates"},
      {AskForBootstrap(), "--bootstrap, --bootstrap-kind and --interval"},
      {recording_bias.has_value(), "--recording-bias"},
      {coverage_check_replicates > 0, "--check-coverage"},
      {preset == "paper", "--preset paper"},
      {include_rr, "--include-rr"}};
  for (const auto& [given, option] : others) {
    if (given) return option;
  }
  return std::nullopt;
}

bool IdentifyArguments::LeaveStructureToData() const {
  return structure.value_or("auto") == "auto" && !OptionOfFreeCoefficients();
}

std::optional<Estimator> IdentifyArguments::ChosenEstimator() const {
  const bool one_step =
      estimator ? *estimator == "one-step" : AskForBootstrap() || preset == "paper";
  if (!one_step && AskForBootstrap()) {
    throw UsageError("--bootstrap, --bootstrap-kind and --interval belong to --estimator one-step");
  }
  const bool output_error = estimator == "output-error";
  if ((one_step || output_error) && parametric_replicates) {
    throw UsageError("--replicates belongs to --estimator weak-iv");
  }
  if (one_step) return Estimator::kOneStep;
  if (output_error) return Estimator::kOutputError;
  if (estimator == "weak-iv") return Estimator::kWeakIv;
  return std::nullopt;
}

RecordingBiasModel IdentifyArguments::ChosenRecordingBias() const {
  const bool several = inputs.logs.size() > 1;
  const bool seeks_them = ChosenEstimator().value_or(Estimator::kWeakIv) == Estimator::kWeakIv;
  if (!recording_bias && several && seeks_them) return RecordingBiasModel::kPerRecording;
  if (recording_bias == "per-recording") return RecordingBiasModel::kPerRecording;
  if (recording_bias == "per-recording-ned") return RecordingBiasModel::kPerRecordingNorthEast;
  return RecordingBiasModel::kShared;
}

IdentifyOptions IdentifyArguments::Options() const {
  IdentifyOptions options;
  options.estimator = ChosenEstimator();
  if (preset) options.prepare = PrepareOptionsOf(PresetNamed(*preset));
  if (sampling_period_s) options.prepare.sampling_period_s = sampling_period_s;
  if (parameterization == "paper") options.regression.parameterization = Parameterization::kPaper;
  if (structure == "fossen") {
    if (const auto option = OptionOfFreeCoefficients()) {
      throw UsageError(std::string(*option) +
                       " belongs to --structure static and dynamic; fossen estimates all of it "
                       "from the readings");
    }
    options.regression.structure = Structure::kFossen;
  }
  if (structure == "dynamic") options.regression.structure = Structure::kFirstOrderDynamic;
  options.regression.include_reverse = include_rr;
  options.regression.recording_bias = ChosenRecordingBias();
  if (dead_zone == "identify") {
    options.dead_zone_source = DeadZoneSource::kIdentified;
  } else if (dead_zone) {
    options.regression.dead_zone = DeadZoneNamed(*dead_zone);
  }
  if (parametric_replicates) options.parametric_replicates = *parametric_replicates;
  if (bootstrap_replicates) options.bootstrap_replicates = *bootstrap_replicates;
  if (bootstrap_kind == "moving-blocks") options.resampling = Resampling::kMovingBlocks;
  if (bootstrap_kind == "parametric") {
    options.resampling = Resampling::kParametric;
    options.interval_method = IntervalMethod::kStudentized;  // which alone takes the bias out
  }
  if (interval == "percentile") options.interval_method = IntervalMethod::kPercentile;
  if (interval == "studentized") options.interval_method = IntervalMethod::kStudentized;
  if (interval == "bca") options.interval_method = IntervalMethod::kBca;
  if (interval_level) options.interval_level = *interval_level;
  options.coverage_check_replicates = coverage_check_replicates;
  options.seed = seed;
  options.threads = threads.value_or(DefaultThreads());
  if (const auto refusal = options.Validate()) {
    throw UsageError(
        WithOptionNames(refusal->subject + ": " + refusal->reason + "; " + refusal->advice));
  }
  return options;
}

}  // namespace telltale
