#include "telltale/core/diagnosis/report/build_report.hpp"

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "telltale/core/base/parallel.hpp"
#include "telltale/core/base/version.hpp"
#include "telltale/core/diagnosis/delays/delay_difference.hpp"
#include "telltale/core/diagnosis/diagnosis_constants.hpp"
#include "telltale/core/diagnosis/hypotheses/detectable_size.hpp"
#include "telltale/core/diagnosis/hypotheses/onset.hpp"
#include "telltale/core/diagnosis/hypotheses/present_weather.hpp"
#include "telltale/core/diagnosis/hypotheses/testability.hpp"
#include "telltale/core/diagnosis/report/causes.hpp"
#include "telltale/core/diagnosis/report/delay_conclusion.hpp"
#include "telltale/core/diagnosis/report/missing_force_text.hpp"
#include "telltale/core/diagnosis/report/pictures.hpp"
#include "telltale/core/diagnosis/report/separation_advice.hpp"
#include "telltale/core/diagnosis/residuals/localisation.hpp"
#include "telltale/core/diagnosis/residuals/missing_force.hpp"

namespace telltale {
namespace {

std::vector<Gap> GapsOf(const ReportInputs& inputs) {
  const Conclusion& conclusion = inputs.conclusion;
  std::vector<Gap> gaps;
  for (const HorizonErrors& horizon : inputs.horizons) {
    std::optional<CrossValidatedErrors> after;
    if (conclusion.is_likely) {
      after = &horizon == &inputs.main ? conclusion.cross_validated
                                       : CrossValidatedErrorsOf(conclusion.folds, horizon.runs,
                                                                inputs.problem.nominal.boat);
    }
    gaps.push_back(GapAt(horizon, after, inputs.seed));
  }
  return gaps;
}

/// The cell with the most excess that is narrower than a channel: "yaw, FR".
std::string NarrowestPlace(const std::vector<GapCell>& cells) {
  for (const GapCell& cell : cells) {
    if (!cell.region && cell.bin.empty()) continue;
    std::string place(Name(cell.channel));
    if (cell.region) place.append(", ").append(Name(*cell.region));
    if (!cell.bin.empty()) place.append(", ").append(cell.bin);
    return place;
  }
  return "";
}

/// The nominal boat with what the verdict names.
AugmentedModel BoatOfTheVerdict(const ReportInputs& inputs) {
  const AugmentedModel& nominal = inputs.problem.nominal.boat;
  if (inputs.conclusion.verdict != Verdict::kPartlyExplained) return nominal;
  return nominal.With(inputs.conclusion.best.effects);
}

/// What stays unexplained: its place and the force it amounts to. Nothing where the gap is
/// explained.
void DescribeTheUnexplained(const ReportInputs& inputs, Diagnosis& diagnosis) {
  if (diagnosis.verdict == Verdict::kExplained) return;
  const AugmentedModel boat = BoatOfTheVerdict(inputs);
  diagnosis.rest =
      NarrowestPlace(diagnosis.verdict == Verdict::kPartlyExplained
                         ? Localise(inputs.recording, inputs.references, boat, inputs.seed)
                         : diagnosis.where);
  diagnosis.missing_force = MissingForceOf(inputs.recording, inputs.references, boat);
  diagnosis.missing_force->sentence = DescribeMissingForce(*diagnosis.missing_force);
}

/// The manoeuvres that separate the likeliest hypothesis from the next ones, and what to record so
/// that a cause shows that the library lacks.
void AdviseOnAnUnknownCause(const ReportInputs& inputs, Diagnosis& diagnosis) {
  constexpr std::size_t kContenders = 3;
  const std::vector<RankedHypothesis>& ranked = inputs.conclusion.ranking.fits;
  RankedHypothesis contenders{ranked.front().fit, ranked.front().probability, {}};
  for (std::size_t i = 1; i < std::min(ranked.size(), kContenders); ++i) {
    contenders.equivalent.push_back(ranked[i].fit);
  }
  diagnosis.advice =
      AdviseSeparatingManoeuvres(contenders, inputs.problem.nominal,
                                 inputs.recording.sampling_period_s, inputs.recording.hull);
  diagnosis.advice.push_back(AdviseRecording(*diagnosis.missing_force));
  diagnosis.notes.push_back(AdviseSensor(contenders));
}

void Advise(const ReportInputs& inputs, Diagnosis& diagnosis) {
  if (!inputs.advise) return;
  const RankedHypothesis& first = inputs.conclusion.ranking.fits.front();
  if (diagnosis.verdict == Verdict::kUnknownCause && first.equivalent.empty()) {
    AdviseOnAnUnknownCause(inputs, diagnosis);
    return;
  }
  if (first.equivalent.empty()) return;
  diagnosis.advice = AdviseSeparatingManoeuvres(
      first, inputs.problem.nominal, inputs.recording.sampling_period_s, inputs.recording.hull);
  const bool is_decisive = !diagnosis.advice.empty() && diagnosis.advice.front().decisive;
  if (is_decisive) return;
  diagnosis.notes.push_back(
      "No manoeuvre of the catalogue is sure to separate the effects that are indistinguishable. " +
      AdviseSensor(first));
}

/// The effects that late channels are, as far as delays show more of them than free runs do.
void StateWhatDelaysShow(const ReportInputs& inputs, std::vector<EffectTestability>& effects) {
  for (const DelayDifference& delay : inputs.delays) {
    const Effect& effect = EffectOf(delay.channel);
    const auto stated = std::ranges::find(effects, effect.Name(), &EffectTestability::effect);
    if (stated == effects.end()) continue;
    const double sigmas = effect.Parameters().front().typical / delay.standard_deviation_s;
    stated->detectability = std::max(stated->detectability, sigmas);
    if (sigmas >= kDiagnosis.testability.detectable_sigmas) {
      stated->testability = Testability::kTestable;
      stated->masked_by.clear();
    }
    if (!inputs.state_power || !delay.detectable_s) continue;
    std::optional<double>& size = stated->detectable_sizes.front().size;
    size = std::min(size.value_or(*delay.detectable_s), *delay.detectable_s);
  }
}

/// The weather that the likeliest hypothesis names; none where there is no evidence of any.
EffectFit ShownWeather(const Conclusion& conclusion) {
  return conclusion.assessment == GapAssessment::kMaterial ? conclusion.best : EffectFit();
}

/// What this recording would show of each effect, beside the weather that it does show.
void StateWhatWouldShow(const ReportInputs& inputs, Diagnosis& diagnosis) {
  const WeatherBeside weather(ShownWeather(inputs.conclusion), inputs.problem);
  diagnosis.present_weather = weather.Names();
  diagnosis.effects.resize(inputs.library.size());
  ForEachIndex(inputs.library.size(), inputs.threads, [&](std::size_t i) {
    const Effect& effect = *inputs.library[i];
    EffectTestability& stated = diagnosis.effects[i];
    stated = TestabilityOf(effect, inputs.problem, weather.Of(effect), inputs.model);
    if (!inputs.state_power) return;
    stated.detectable_sizes =
        DetectableSizesOf(effect, inputs.problem, weather.Of(effect), inputs.main.floor.scale,
                          inputs.days, inputs.hypotheses.nominal_gains.at(&effect));
  });
}

void DescribeMaterialGap(const ReportInputs& inputs, Diagnosis& diagnosis) {
  diagnosis.where =
      Localise(inputs.recording, inputs.references, inputs.problem.nominal.boat, inputs.seed);
  DescribeTheUnexplained(inputs, diagnosis);
  diagnosis.causes = CausesOf(inputs.conclusion, inputs.problem, inputs.main, inputs.seed);
  diagnosis.unknown_odds = inputs.conclusion.ranking.unknown_odds;
  Advise(inputs, diagnosis);
}

}  // namespace

Diagnosis BuildReport(const ReportInputs& inputs) {
  const Conclusion& conclusion = inputs.conclusion;
  Diagnosis diagnosis;
  diagnosis.verdict = conclusion.verdict;
  diagnosis.start_s = inputs.recording.StartTime();
  diagnosis.end_s = inputs.recording.EndTime();
  diagnosis.seed = inputs.seed;
  diagnosis.software_version = Version();
  diagnosis.gaps = GapsOf(inputs);
  diagnosis.delays = inputs.delays;
  StateWhatWouldShow(inputs, diagnosis);
  StateWhatDelaysShow(inputs, diagnosis.effects);
  if (conclusion.assessment == GapAssessment::kMaterial) DescribeMaterialGap(inputs, diagnosis);
  if (conclusion.assessment == GapAssessment::kUndecided) {
    diagnosis.notes.emplace_back(
        "No effect of the library explains enough of the gap. Weather, or what the references "
        "leave uncertain about the boat, may account for it: record longer, or name more "
        "references.");
  }
  if (std::string note = DescribeLateChannels(inputs.delays); !note.empty()) {
    diagnosis.notes.push_back(std::move(note));
  }
  if (conclusion.is_likely) diagnosis.onset = OnsetOf(conclusion.best, inputs.problem);
  diagnosis.pictures =
      PicturesOf(inputs.recording, inputs.main, inputs.problem.nominal.boat, conclusion);
  return diagnosis;
}

}  // namespace telltale
