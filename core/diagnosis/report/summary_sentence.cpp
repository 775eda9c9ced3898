#include "telltale/core/diagnosis/report/summary_sentence.hpp"

#include <algorithm>

#include "telltale/core/effects/wording.hpp"

namespace telltale {
namespace {

std::string WithCapital(std::string text) {
  if (!text.empty() && text.front() >= 'a' && text.front() <= 'z') {
    text.front() = static_cast<char>(text.front() - 'a' + 'A');
  }
  return text;
}

/// The effects of a cause, with those that are indistinguishable from it.
std::string EffectsIn(const Cause& cause) {
  std::string all;
  for (const CausalEffect& effect : cause.effects) {
    all.append(all.empty() ? "" : ", and ").append(effect.sentence);
  }
  if (cause.indistinguishable.empty()) return all;
  all += " (or ";
  for (std::size_t i = 0; i < cause.indistinguishable.size(); ++i) {
    all.append(i == 0 ? "" : ", ").append(cause.indistinguishable[i]);
  }
  return all + ": this recording does not separate them)";
}

/// "81 % [74, 87] of the gap".
std::string ShareIn(const std::optional<ExcessExplained>& excess_explained) {
  if (!excess_explained) return "the free runs show no gap in size";
  const auto whole = [](double share) { return FormatNumber(100.0 * share, 0); };
  return whole(excess_explained->share) + " % [" + whole(excess_explained->interval.lower) + ", " +
         whole(excess_explained->interval.upper) + "] of the gap";
}

const Cause* FirstNamed(const Diagnosis& diagnosis) {
  const auto named = std::find_if(diagnosis.causes.begin(), diagnosis.causes.end(),
                                  [](const Cause& cause) { return !cause.effects.empty(); });
  return named == diagnosis.causes.end() ? nullptr : &*named;
}

/// " Missing is a constant surge force of -2 N." Empty where it is not known.
std::string MissingForceIn(const Diagnosis& diagnosis) {
  if (!diagnosis.missing_force || diagnosis.missing_force->sentence.empty()) return "";
  return " Missing is " + diagnosis.missing_force->sentence + ".";
}

/// The likely cause where none is named, if there is one.
std::string UncertainCause(const Diagnosis& diagnosis, const std::string& times) {
  const bool likely = !diagnosis.causes.empty() && !diagnosis.causes.front().effects.empty();
  if (likely) {
    const Cause& first = diagnosis.causes.front();
    return "Most likely (" + FormatNumber(100.0 * first.probability, 0) + " %), but not certain, " +
           EffectsIn(first) + ": " + ShareIn(first.excess_explained) + ".";
  }
  return "The model no longer matches the boat (" + times +
         " times the normal error), and no effect of the library explains it" +
         (diagnosis.rest.empty() ? "." : "; the error sits in " + diagnosis.rest + ".") +
         MissingForceIn(diagnosis);
}

/// What the normal error comes from.
std::string NormalIn(const Diagnosis& diagnosis) {
  return diagnosis.floor_basis == FloorBasis::kReferenceLogs ? "on the references"
                                                             : "the sensors' noise allows";
}

}  // namespace

std::string SummarySentence(const Diagnosis& diagnosis) {
  const GapSize& gap = diagnosis.Main().all;
  const std::string times = FormatNumber(gap.before / gap.noise_floor, 1);
  const Cause* cause = FirstNamed(diagnosis);
  switch (diagnosis.verdict) {
    case Verdict::kNoMaterialGap:
      return "No material gap: the model matches the boat as well as " + NormalIn(diagnosis) +
             " (" + times + " times the normal error).";
    case Verdict::kInsufficientData:
      return "The data cannot answer whether the model still matches the boat.";
    case Verdict::kExplained:
      return WithCapital(EffectsIn(*cause)) + ": " + ShareIn(cause->excess_explained) +
             "; the rest is within noise.";
    case Verdict::kPartlyExplained:
      return WithCapital(EffectsIn(*cause)) + ": " + ShareIn(cause->excess_explained) +
             "; the rest is unknown" +
             (diagnosis.rest.empty() ? "" : " and sits in " + diagnosis.rest) + ".";
    case Verdict::kUnknownCause: return UncertainCause(diagnosis, times);
    case Verdict::kUnknown: break;
  }
  return "Not diagnosed.";
}

}  // namespace telltale
