#include "telltale/client/workbench/identify_choices.hpp"

#include <string_view>
#include <utility>

#include <boost/algorithm/string/replace.hpp>

#include "telltale/client/workbench/default_threads.hpp"
#include "telltale/client/workbench/errors.hpp"
#include "telltale/client/workbench/presets.hpp"

namespace telltale {
namespace {

using Replacement = std::pair<std::string_view, std::string_view>;

/// A refusal of a number: "FIELD = 3 must be ...; set FIELD to a value".
std::string WithOptionInPlaceOfField(std::string text) {
  constexpr Replacement kOptionOfField[] = {{"coverage_check_replicates ", "--check-coverage "},
                                            {"parametric_replicates ", "--replicates "},
                                            {"bootstrap_replicates ", "--bootstrap "},
                                            {"sampling_period_s ", "--sampling-period "},
                                            {"interval_level ", "--level "},
                                            {"threads ", "--threads "}};
  for (const Replacement& option : kOptionOfField) {
    const std::string field(option.first);
    if (!text.starts_with("identification: " + field) &&
        !text.starts_with("data preparation: " + field)) {
      continue;
    }
    boost::replace_all(text, option.first, option.second);
    break;
  }
  return text;
}

/// With the options and values that were typed in place of the fields that they set.
std::string WithOptionNames(const Refusal& refusal) {
  constexpr Replacement kOptionOfSubject[] = {{"estimator", "--estimator"},
                                              {"recording_bias", "--recording-bias"},
                                              {"resampling", "--bootstrap-kind"},
                                              {"dead_zone", "--dead-zone"}};
  constexpr Replacement kTypedValues[] = {
      {"OUTPUT_ERROR", "output-error"}, {"ONE_STEP", "one-step"},
      {"WEAK_IV", "weak-iv"},           {"SHARED", "shared"},
      {"SEGMENTS", "slices"},           {"PARAMETRIC", "parametric"}};
  std::string said = refusal.reason + "; " + refusal.advice;
  for (const auto& [subject, option] : kOptionOfSubject) {
    if (refusal.subject != subject) continue;
    for (const auto& [value, typed] : kTypedValues) boost::replace_all(said, value, typed);
    return std::string(option) + ": " + said;
  }
  return WithOptionInPlaceOfField(refusal.subject + ": " + said);
}

}  // namespace

const OptionNames& StructureNames() {
  static const OptionNames names = {"fossen", "static", "dynamic", "auto"};
  return names;
}

const OptionNames& ParameterizationNames() {
  static const OptionNames names = {"propeller", "paper"};
  return names;
}

const OptionNames& EstimatorNames() {
  static const OptionNames names = {"auto", "one-step", "weak-iv", "output-error"};
  return names;
}

const OptionNames& BootstrapKindNames() {
  static const OptionNames names = {"slices", "moving-blocks", "parametric"};
  return names;
}

const OptionNames& IntervalNames() {
  static const OptionNames names = {"percentile", "studentized", "bca"};
  return names;
}

const OptionNames& RecordingBiasNames() {
  static const OptionNames names = {"shared", "per-recording", "per-recording-ned"};
  return names;
}

void IdentifyChoices::RequireKnownNames() const {
  const auto require = [](const OptionNames& names, const char* option,
                          const std::optional<std::string>& value) {
    if (value) RequireOneOf(names, option, *value);
  };
  require(StructureNames(), "--structure", structure);
  require(ParameterizationNames(), "--parameterization", parameterization);
  require(EstimatorNames(), "--estimator", estimator);
  require(PresetNames(), "--preset", preset);
  require(BootstrapKindNames(), "--bootstrap-kind", bootstrap_kind);
  require(IntervalNames(), "--interval", interval);
  require(RecordingBiasNames(), "--recording-bias", recording_bias);
}

bool IdentifyChoices::AskForBootstrap() const {
  return bootstrap_replicates || bootstrap_kind || interval;
}

std::optional<std::string_view> IdentifyChoices::OptionOfFreeCoefficients() const {
  const std::pair<bool, std::string_view> others[] = {
      {parameterization.has_value(), "--parameterization"},
      {ChooseDeadZone(), "--dead-zone"},
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

bool IdentifyChoices::LeaveStructureToData() const {
  return structure == "auto" && !OptionOfFreeCoefficients();
}

Structure IdentifyChoices::ChosenStructure() const {
  const auto option = OptionOfFreeCoefficients();
  if (structure == "fossen" && option) {
    throw UsageError(std::string(*option) +
                     " belongs to --structure static and dynamic: fossen has one estimator, which "
                     "works on the readings as they are, and one set of parameters");
  }
  if (structure == "dynamic") return Structure::kFirstOrderDynamic;
  return structure.value_or("fossen") == "fossen" && !option ? Structure::kFossen
                                                             : Structure::kStaticQuadratic;
}

std::optional<Estimator> IdentifyChoices::ChosenEstimator() const {
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

RecordingBiasModel IdentifyChoices::ChosenRecordingBias(std::size_t recordings) const {
  const bool several = recordings > 1;
  const bool seeks_them = ChosenEstimator().value_or(Estimator::kWeakIv) == Estimator::kWeakIv;
  if (!recording_bias && several && seeks_them) return RecordingBiasModel::kPerRecording;
  if (recording_bias == "per-recording") return RecordingBiasModel::kPerRecording;
  if (recording_bias == "per-recording-ned") return RecordingBiasModel::kPerRecordingNorthEast;
  return RecordingBiasModel::kShared;
}

IdentifyOptions IdentifyChoices::Options(std::size_t recordings) const {
  RequireKnownNames();
  IdentifyOptions options;
  options.estimator = ChosenEstimator();
  if (preset) options.prepare = PrepareOptionsOf(PresetNamed(*preset));
  if (sampling_period_s) options.prepare.sampling_period_s = sampling_period_s;
  if (parameterization == "paper") options.regression.parameterization = Parameterization::kPaper;
  options.regression.structure = ChosenStructure();
  options.regression.include_reverse = include_rr;
  options.regression.recording_bias = ChosenRecordingBias(recordings);
  if (identify_dead_zone) options.dead_zone_source = DeadZoneSource::kIdentified;
  if (dead_zone) options.regression.dead_zone = *dead_zone;
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
    throw UsageError(WithOptionNames(*refusal));
  }
  return options;
}

}  // namespace telltale
