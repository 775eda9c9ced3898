#include "telltale/core/diagnosis/report/reference_influence.hpp"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <utility>

#include "telltale/core/base/parallel.hpp"
#include "telltale/core/diagnosis/delays/delay_difference.hpp"
#include "telltale/core/diagnosis/diagnosis_constants.hpp"
#include "telltale/core/diagnosis/report/conclusion.hpp"
#include "telltale/core/diagnosis/report/delay_conclusion.hpp"
#include "telltale/core/diagnosis/report/horizon_gap.hpp"
#include "telltale/core/diagnosis/residuals/gap.hpp"

namespace telltale {
namespace {

std::string NameOf(std::size_t reference, const std::vector<std::string>& names) {
  return reference < names.size() ? names[reference] : "reference " + std::to_string(reference + 1);
}

/// The places of all recordings but the one that is left out.
std::vector<std::size_t> Kept(const std::vector<FreeRuns>& recordings,
                              const PreparedDataset& left_out) {
  std::vector<std::size_t> kept;
  for (std::size_t i = 0; i < recordings.size(); ++i) {
    if (&recordings[i].Dataset() != &left_out) kept.push_back(i);
  }
  return kept;
}

NoiseFloor FloorOf(const std::vector<std::size_t>& kept, const std::vector<FreeRuns>& recordings,
                   const NominalBaseline& nominal) {
  std::vector<Eigen::MatrixXd> errors;
  std::vector<std::vector<std::size_t>> blocks;
  for (std::size_t i = 0; i < kept.size(); ++i) {
    errors.push_back(nominal.days[i].errors);
    blocks.push_back(BlocksOf(recordings[kept[i]]));
  }
  return NoiseFloorOf(errors, blocks);
}

/// What the reference leaves that took no part; none where it has no windows. `all` is the baseline
/// of all references, with the slopes of each.
std::optional<LeftOutDay> DayOf(const PreparedDataset& left_out,
                                const std::vector<FreeRuns>& recordings, const NominalBaseline& all,
                                const NominalBaseline& without, const NoiseFloor& floor) {
  const auto own = std::find_if(recordings.begin(), recordings.end(),
                                [&](const FreeRuns& runs) { return &runs.Dataset() == &left_out; });
  if (own == recordings.end()) return std::nullopt;
  Sensitivity day = all.days[static_cast<std::size_t>(own - recordings.begin())];
  day.errors = own->Errors(without.boat);
  const ResidualMetric metric(without, day, EveryWindow(day), false);
  return LeftOutDay{SquaredGaps(day.errors, floor.scale, kAllChannels).mean(),
                    metric.ReducedChiSquare(metric.Whiten(day.errors))};
}

/// The likeliest cause where the gap is material, an unknown one among them.
void DescribeCause(const Conclusion& conclusion, ReferenceInfluence& influence) {
  if (conclusion.assessment != GapAssessment::kMaterial) return;
  const Ranking& ranking = conclusion.ranking;
  const auto first =
      std::max_element(ranking.fits.begin(), ranking.fits.end(),
                       [](const auto& a, const auto& b) { return a.probability < b.probability; });
  influence.probability = ranking.unknown + ranking.no_effect;
  if (first == ranking.fits.end() || first->probability < influence.probability) return;
  influence.effects = first->fit.Names();
  influence.probability = first->probability;
}

/// The recording that is left out, where it has windows, and the one to diagnose.
std::vector<const FreeRuns*> OthersOf(const PreparedDataset& left_out,
                                      const std::vector<FreeRuns>& recordings,
                                      const DiagnosisProblem& problem) {
  std::vector<const FreeRuns*> others = {&problem.runs};
  for (const FreeRuns& runs : recordings) {
    if (&runs.Dataset() == &left_out) others.push_back(&runs);
  }
  return others;
}

/// The nominal boat without one reference, and what that one leaves by it.
struct WithoutOne {
  NominalBaseline nominal;
  NoiseFloor floor;
  std::optional<LeftOutDay> day;
};

/// Whether the boat errs so much farther on the recording than that of all references that the step
/// to it was too long to trust.
bool IsAstray(const NominalBaseline& nominal, const NoiseFloor& floor,
              const DiagnosisProblem& all) {
  const auto squared_gap = [&](const Eigen::MatrixXd& errors) {
    return SquaredGaps(errors, floor.scale, kAllChannels).mean();
  };
  return squared_gap(all.runs.Errors(nominal.boat)) >
         kDiagnosis.baseline.astray_ratio * std::max(squared_gap(all.recording.errors), 1.0);
}

/// The nominal boat of these references alone, learned as that of all was.
NominalBaseline LearnedFrom(const std::vector<std::size_t>& kept, const InfluenceInputs& inputs,
                            std::vector<const FreeRuns*> others) {
  std::vector<FreeRuns> references;
  for (const std::size_t i : kept) {
    references.emplace_back(inputs.main.references[i].Dataset(), inputs.model.model,
                            inputs.problem.runs.HorizonS());
  }
  constexpr std::size_t kThreads = 1;  // references stand side by side
  return LearnNominalBaseline(references, inputs.model, inputs.problem.parameter_refs, kThreads,
                              std::move(others));
}

/// None where the others have no windows.
std::optional<WithoutOne> Without(const PreparedDataset& left_out, const InfluenceInputs& inputs) {
  const std::vector<FreeRuns>& recordings = inputs.main.references;
  const std::vector<std::size_t> kept = Kept(recordings, left_out);
  if (kept.empty()) return std::nullopt;
  const DiagnosisProblem& all = inputs.problem;
  WithoutOne without;
  without.nominal = NominalBaselineOf(kept, all.nominal, recordings, inputs.model,
                                      all.parameter_refs, OthersOf(left_out, recordings, all));
  without.floor = FloorOf(kept, recordings, without.nominal);
  if (IsAstray(without.nominal, without.floor, all)) {
    without.nominal = LearnedFrom(kept, inputs, OthersOf(left_out, recordings, all));
    without.floor = FloorOf(kept, recordings, without.nominal);
  }
  without.day = DayOf(left_out, recordings, all.nominal, without.nominal, without.floor);
  return without;
}

/// What 99 % of days stay below in G^2, by the other references when they were left out, (123);
/// none of fewer than two.
std::optional<double> SquaredLimitOfOthers(
    std::size_t reference, const std::vector<std::optional<WithoutOne>>& without_each) {
  std::vector<double> squared_gaps;
  for (std::size_t other = 0; other < without_each.size(); ++other) {
    if (other == reference || !without_each[other] || !without_each[other]->day) continue;
    squared_gaps.push_back(without_each[other]->day->squared_gap);
  }
  if (squared_gaps.size() < 2) return std::nullopt;
  return SquaredLimitOfDays(squared_gaps);
}

ReferenceInfluence AnswerWithout(std::size_t reference, const WithoutOne& without,
                                 std::optional<double> squared_limit,
                                 const InfluenceInputs& inputs) {
  const DiagnosisProblem& all = inputs.problem;
  Sensitivity recording = all.recording;
  recording.errors = all.runs.Errors(without.nominal.boat);
  const ResidualMetric metric(without.nominal, recording, EveryWindow(recording),
                              all.metric.FreesCoefficients());
  const DiagnosisProblem problem{all.runs, without.nominal,    recording,
                                 metric,   all.parameter_refs, all.excitation};
  const HorizonErrors main{all.runs, without.floor, recording.errors};
  constexpr std::size_t kThreads = 1;  // references stand side by side
  const Hypotheses hypotheses = Search(
      problem, inputs.library, inputs.most_effects, kThreads, [](double) {}, inputs.hypotheses);
  Conclusion conclusion = Conclude(hypotheses, problem, main, inputs.seed, squared_limit);
  ConcludeFromDelays(DelayDifferencesOf(inputs.delays, reference), inputs.library, problem, main,
                     inputs.seed, conclusion);

  ReferenceInfluence influence;
  influence.verdict = conclusion.verdict;
  if (without.day) influence.own_gap = std::sqrt(without.day->squared_gap);
  std::optional<CrossValidatedErrors> after;
  if (conclusion.is_likely) after = conclusion.cross_validated;
  influence.gap = GapAt(main, after, inputs.seed).all;
  DescribeCause(conclusion, influence);
  return influence;
}

}  // namespace

Influences InfluencesOf(const InfluenceInputs& inputs,
                        const std::function<void(double)>& report_progress) {
  const std::size_t references = inputs.references.size();
  std::vector<std::optional<WithoutOne>> without_each(references);
  ForEachIndex(references, inputs.threads,
               [&](std::size_t i) { without_each[i] = Without(inputs.references[i], inputs); });
  Influences influences;
  influences.answers.resize(references);
  std::mutex reporting;
  std::size_t done = 0;
  ForEachIndex(references, inputs.threads, [&](std::size_t i) {
    ReferenceInfluence& answer = influences.answers[i];
    if (without_each[i]) {
      answer = AnswerWithout(i, *without_each[i], SquaredLimitOfOthers(i, without_each), inputs);
    }
    answer.reference = NameOf(i, inputs.names);
    const std::lock_guard lock(reporting);
    report_progress(static_cast<double>(++done) / static_cast<double>(references));
  });
  for (const auto& without : without_each) {
    if (without && without->day) influences.days.push_back(*without->day);
  }
  return influences;
}

std::string DescribeInfluences(const std::vector<ReferenceInfluence>& influences, Verdict verdict) {
  std::string deciding;
  for (const ReferenceInfluence& influence : influences) {
    if (influence.verdict == verdict) continue;
    deciding.append(deciding.empty() ? "" : ", ")
        .append(influence.reference)
        .append(" (")
        .append(Name(influence.verdict))
        .append(")");
  }
  if (deciding.empty()) return deciding;
  return "Without one of these references the verdict is another: " + deciding +
         ". More references would settle it.";
}

}  // namespace telltale
