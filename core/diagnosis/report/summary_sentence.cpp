#include "telltale/core/diagnosis/report/summary_sentence.hpp"

#include <algorithm>
#include <cmath>

#include "telltale/core/effects/wording.hpp"

namespace telltale {
namespace {

std::string WithCapital(std::string text) {
  if (!text.empty() && text.front() >= 'a' && text.front() <= 'z') {
    text.front() = static_cast<char>(text.front() - 'a' + 'A');
  }
  return text;
}

std::string WhatIsWrong(const Cause& cause) {
  std::string all;
  for (const CausalEffect& effect : cause.effects) {
    all.append(all.empty() ? "" : ", and ").append(effect.sentence);
  }
  if (cause.indistinguishable.empty()) return all;
  all += " (or ";
  for (std::size_t i = 0; i < cause.indistinguishable.size(); ++i) {
    all.append(i == 0 ? "" : ", ").append(cause.indistinguishable[i]);
  }
  return all + ": this recording cannot tell)";
}

std::string HowMuch(const std::optional<ExcessExplained>& excess_explained) {
  if (!excess_explained) return "too little to see in the free runs' size";
  const auto whole = [](double share) { return FormatNumber(100.0 * share, 0); };
  return whole(excess_explained->share) + " % [" + whole(excess_explained->interval.lower) + ", " +
         whole(excess_explained->interval.upper) + "] of the gap";
}

const Cause* FirstNamed(const Diagnosis& diagnosis) {
  const auto named = std::find_if(diagnosis.causes.begin(), diagnosis.causes.end(),
                                  [](const Cause& cause) { return !cause.effects.empty(); });
  return named == diagnosis.causes.end() ? nullptr : &*named;
}

/// Where no cause is named for sure: the likely one, if there is any.
std::string WhatMayBeWrong(const Diagnosis& diagnosis, const std::string& times) {
  const bool likely = !diagnosis.causes.empty() && !diagnosis.causes.front().effects.empty();
  if (likely) {
    const Cause& first = diagnosis.causes.front();
    return "Most likely (" + FormatNumber(100.0 * first.probability, 0) +
           " %), but not for sure, " + WhatIsWrong(first) + ": " + HowMuch(first.excess_explained) +
           ".";
  }
  return "Model and boat part (" + times +
         " times the nominal error), by something the library does not hold" +
         (diagnosis.rest.empty() ? "." : "; it sits in " + diagnosis.rest + ".");
}

}  // namespace

std::string SummarySentence(const Diagnosis& diagnosis) {
  const GapSize& gap = diagnosis.Main().all;
  const std::string times = FormatNumber(gap.before / gap.noise_floor, 1);
  const Cause* cause = FirstNamed(diagnosis);
  switch (diagnosis.verdict) {
    case Verdict::kNoMaterialGap:
      return "No material gap: the model follows the boat as well as on nominal days (" + times +
             " times their error).";
    case Verdict::kInsufficientData: return "The data cannot tell whether model and boat part.";
    case Verdict::kExplained:
      return WithCapital(WhatIsWrong(*cause)) + ": " + HowMuch(cause->excess_explained) +
             "; the rest is within noise.";
    case Verdict::kPartlyExplained:
      return WithCapital(WhatIsWrong(*cause)) + ": " + HowMuch(cause->excess_explained) +
             "; the rest is unknown" +
             (diagnosis.rest.empty() ? "" : " and sits in " + diagnosis.rest) + ".";
    case Verdict::kUnknownCause: return WhatMayBeWrong(diagnosis, times);
    case Verdict::kUnknown: break;
  }
  return "Not diagnosed.";
}

}  // namespace telltale
