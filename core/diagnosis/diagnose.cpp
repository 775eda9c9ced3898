#include "telltale/core/diagnosis/diagnose.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "telltale/core/base/format_number.hpp"
#include "telltale/core/base/range.hpp"
#include "telltale/core/diagnosis/baseline/synthetic_references.hpp"
#include "telltale/core/diagnosis/delays/delay_difference.hpp"
#include "telltale/core/diagnosis/hypotheses/augmented_identification.hpp"
#include "telltale/core/diagnosis/hypotheses/power.hpp"
#include "telltale/core/diagnosis/hypotheses/stochastic_excitation.hpp"
#include "telltale/core/diagnosis/report/build_report.hpp"
#include "telltale/core/diagnosis/report/delay_conclusion.hpp"
#include "telltale/core/diagnosis/report/reference_influence.hpp"
#include "telltale/core/diagnosis/report/summary_sentence.hpp"
#include "telltale/core/diagnosis/residuals/horizon_runs.hpp"
#include "telltale/core/diagnosis/residuals/wiring_check.hpp"

namespace telltale {
namespace {

constexpr std::string_view kSubject = "options";

std::vector<const Effect*> LibraryWithout(const std::vector<std::string>& names) {
  std::vector<const Effect*> library;
  for (const Effect* effect : EffectLibrary()) {
    if (std::find(names.begin(), names.end(), effect->Name()) == names.end()) {
      library.push_back(effect);
    }
  }
  return library;
}

std::optional<Refusal> CheckRecording(const PreparedDataset& recording) {
  double recorded_s = 0.0;
  for (const RowRange& segment : recording.segments) {
    recorded_s += static_cast<double>(segment.size()) * recording.sampling_period_s;
  }
  if (recorded_s < kMinimumDiagnosedS) {
    return Refusal{"recording", "it is " + std::to_string(std::lround(recorded_s)) + " s long",
                   "record at least " + std::to_string(std::lround(kMinimumDiagnosedS)) + " s"};
  }
  const Nu fastest = FastestOf(recording);
  if (std::max({fastest.u, fastest.v, fastest.r}) < kDiagnosis.recording.minimum_speed) {
    return Refusal{"recording", "the boat is at rest throughout", "record the boat under way"};
  }
  return std::nullopt;
}

std::optional<Refusal> CheckVehicles(const std::string& of_model, const std::string& of_recording) {
  if (of_model.empty() || of_recording.empty() || of_model == of_recording) return std::nullopt;
  return Refusal{"model", "it is of " + of_model + ", the recording of " + of_recording,
                 "name a model of the same boat"};
}

std::optional<Refusal> CheckRequest(const PreparedDataset& recording, const VesselModel& model,
                                    const std::string& model_vehicle_id,
                                    const std::string& vehicle_id) {
  if (auto refusal = CheckVehicles(model_vehicle_id, vehicle_id)) return refusal;
  if (auto refusal = CheckRecording(recording)) return refusal;
  return SuspectedWiringFault(recording, model);
}

/// Free-run scores of the old model and of the augmented one on the recording.
std::optional<Improvement> ImprovementOf(const PreparedDataset& recording,
                                         const VesselModel& before, const AugmentedModel& after) {
  const ValidationOptions options = UsualOptions(recording.sampling_period_s);
  const auto scores_before = Validate(recording, before, options);
  const auto scores_after = Validate(recording, after, options);
  if (!scores_before || !scores_after) return std::nullopt;
  return Improvement{scores_before->free_run, scores_after->free_run};
}

/// What the references do to the answer.
void NoteInfluences(std::vector<ReferenceInfluence> influences, std::optional<double> squared_limit,
                    Diagnosis& diagnosis) {
  std::string note = DescribeInfluences(influences, diagnosis.verdict);
  if (!note.empty()) diagnosis.notes.push_back(std::move(note));
  if (squared_limit) {
    diagnosis.nominal_days_limit = std::sqrt(*squared_limit);
    diagnosis.notes.push_back(
        "References that took no part in the baseline say that 99 % of nominal "
        "days stay below a gap of " +
        FormatNumber(*diagnosis.nominal_days_limit, 2) +
        ". A smaller gap without a certain cause counts as undecided.");
  }
  diagnosis.reference_influence = std::move(influences);
}

/// Diagnose() with a model and references that are known to be usable.
Result<DiagnosedModel> DiagnoseAgainst(const std::vector<PreparedDataset>& references,
                                       const PreparedDataset& recording,
                                       const Identification& identification,
                                       const UncertainModel& model, const ComparedDelays& delays,
                                       const DiagnoseOptions& options, const Progress& progress) {
  const auto report_progress = [&](std::string_view stage, double share) {
    if (progress) progress(stage, share);
  };
  const std::vector<const Effect*> library = LibraryWithout(options.without);
  const std::vector<EffectParameterRef> parameter_refs = EffectParameterRefsOf(library);

  report_progress("free runs", 0.05);
  const auto runs = BuildFreeRuns(recording, references, model.model, options.threads);
  if (!runs) return tl::unexpected<Refusal>(runs.error());

  report_progress("nominal boat", 0.1);
  const NominalBaseline nominal = LearnNominalBaseline(
      runs->Main().references, model, parameter_refs, options.threads, {&runs->Main().recording});
  const std::vector<HorizonErrors> horizons = HorizonErrorsOf(*runs, nominal.boat);
  const HorizonErrors& main = horizons[runs->main];

  report_progress("sensitivities", 0.35);
  const Sensitivity sensitivity = SensitivityOf(main.runs, {nominal.boat, nominal.coefficients},
                                                model, parameter_refs, options.threads);
  const ResidualMetric metric(nominal, sensitivity, EveryWindow(sensitivity), options.refit);
  const ObservedExcitation excitation =
      ObservedExcitationOf(library, main.runs, references, nominal.boat, sensitivity.errors);
  const DiagnosisProblem problem{main.runs, nominal,        sensitivity,
                                 metric,    parameter_refs, excitation};

  const Hypotheses hypotheses =
      Search(problem, library, options.most_effects, options.threads,
             [&](double share) { report_progress("effects", 0.4 + 0.2 * share); });
  Influences influences;
  if (options.leave_out_references && references.size() > 1) {
    report_progress("references", 0.6);
    influences =
        InfluencesOf({references, options.reference_names, runs->Main(), problem, model, library,
                      hypotheses, delays, options.most_effects, options.seed, options.threads},
                     [&](double share) { report_progress("references", 0.6 + 0.25 * share); });
  }
  const DayToDay days = DayToDayOf(nominal, influences.days);
  const std::vector<DelayDifference> differences = DelayDifferencesOf(delays);
  Conclusion conclusion = Conclude(hypotheses, problem, main, options.seed, days.squared_limit);
  ConcludeFromDelays(differences, library, problem, main, options.seed, conclusion);

  report_progress("report", 0.85);
  DiagnosedModel diagnosed;
  diagnosed.diagnosis = BuildReport({recording, references, model, library, horizons, main, problem,
                                     hypotheses, conclusion, days, differences, options.advise,
                                     options.state_power, options.seed, options.threads});
  if (conclusion.is_likely) {
    const AugmentedModel boat = Reidentified(conclusion.best, problem, model);
    diagnosed.augmented = Augmented(identification, boat, conclusion.best, problem, model);
    diagnosed.diagnosis.improvement = ImprovementOf(recording, model.model, boat);
  }
  NoteInfluences(std::move(influences.answers), days.squared_limit, diagnosed.diagnosis);
  report_progress("done", 1.0);
  return diagnosed;
}

void DescribeReferences(std::size_t reference_logs, Diagnosis& diagnosis) {
  diagnosis.floor_basis =
      reference_logs == 0 ? FloorBasis::kSensorNoise : FloorBasis::kReferenceLogs;
  diagnosis.reference_logs = reference_logs;
  if (reference_logs > 0 && reference_logs < kDiagnosis.recording.few_references) {
    diagnosis.notes.emplace_back(
        "Fewer than three reference logs: the difference between nominal days is mostly assumed.");
  }
}

}  // namespace

std::optional<Refusal> DiagnoseOptions::Validate() const {
  auto refusal = OutOfRange(kSubject, "most_effects", static_cast<double>(most_effects), 1.0,
                            static_cast<double>(kDiagnosis.search.most_effects));
  if (refusal) return refusal;
  refusal = OutOfRange(kSubject, "threads", static_cast<double>(threads), 1.0, 256.0);
  if (refusal) return refusal;
  for (const std::string& name : without) {
    if (FindEffect(name) != nullptr) continue;
    std::string known;
    for (const Effect* effect : EffectLibrary()) {
      known.append(known.empty() ? "" : ", ").append(effect->Name());
    }
    return Refusal{"without", "there is no effect \"" + name + "\"", "name one of " + known};
  }
  return std::nullopt;
}

Result<DiagnosedModel> Diagnose(const PreparedDataset& recording,
                                const std::vector<PreparedDataset>& references,
                                const Identification& model, const std::string& vehicle_id,
                                const DiagnoseOptions& options, const Progress& progress) {
  if (auto refusal = options.Validate()) return tl::unexpected<Refusal>(*std::move(refusal));
  const auto uncertain = UncertainModelOf(model);
  if (!uncertain) return tl::unexpected<Refusal>(uncertain.error());
  if (auto refusal = CheckRequest(recording, uncertain->model, model.vehicle_id, vehicle_id)) {
    return tl::unexpected<Refusal>(*std::move(refusal));
  }
  const std::vector<PreparedDataset> synthetic =
      references.empty() ? SyntheticReferences(recording, uncertain->model, options.seed)
                         : std::vector<PreparedDataset>{};
  if (references.empty() && synthetic.empty()) {
    return Refuse("model", "its simulation of this recording diverges",
                  "identify the boat again, or name reference logs");
  }
  ComparedDelays delays;
  if (model.physical && references.size() >= kDiagnosis.delays.least_references) {
    delays = ComparedDelaysOf(recording, references, *model.physical, options.threads,
                              [&](double share) {
                                if (progress) progress("delays", 0.05 * share);
                              });
  }
  auto answer = DiagnoseAgainst(references.empty() ? synthetic : references, recording, model,
                                *uncertain, delays, options, progress);
  if (!answer) return tl::unexpected<Refusal>(std::move(answer).error());
  Diagnosis& diagnosis = answer->diagnosis;
  diagnosis.vehicle_id = vehicle_id;
  DescribeReferences(references.size(), diagnosis);
  diagnosis.sentence = SummarySentence(diagnosis);
  return answer;
}

}  // namespace telltale
