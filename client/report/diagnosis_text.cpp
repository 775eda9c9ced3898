#include "telltale/client/report/diagnosis_text.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <iterator>
#include <numbers>

#include "telltale/client/report/number_text.hpp"
#include "telltale/core/base/degrees.hpp"
#include "telltale/core/effects/wording.hpp"

namespace telltale {
namespace {

/// So many that a standard error shows two digits.
int DecimalsFor(double standard_error) {
  constexpr int kMost = 6;
  if (!std::isfinite(standard_error) || standard_error <= 0.0) return 3;
  return std::clamp(1 - static_cast<int>(std::floor(std::log10(standard_error))), 0, kMost);
}

std::string EstimateText(const ParameterEstimate& parameter) {
  const std::string unit =
      parameter.unit.empty() || parameter.unit == "1" ? "" : ' ' + parameter.unit;
  const int decimals = DecimalsFor(parameter.standard_error);
  return Fixed(parameter.estimate, decimals) + " ± " + Fixed(parameter.standard_error, decimals) +
         unit;
}

/// "any" where the interval holds half of all directions.
std::string DirectionText(const CircularInterval& towards) {
  if (towards.half_width_rad >= std::numbers::pi / 2.0) return "any";
  return Fixed(towards.centre_rad * kDegreesPerRadian, 0) + " ± " +
         Fixed(towards.half_width_rad * kDegreesPerRadian, 0) + " deg (95 %)" +
         (towards.or_opposite ? ", or the opposite way" : "");
}

/// A term of the odds of an unknown cause in words; its name where it is of another version.
std::string TermText(const OddsTerm& term) {
  if (term.name == "constant") return "to begin with";
  if (term.name == "log_unexplained_share") return "by the share of the excess that is left";
  if (term.name == "log_misfit") return "by the errors that are left";
  if (term.name == "log_median_misfit") return "by the errors of the median window";
  if (term.name == "predictable")
    return "by what effects still predict of the errors that are left";
  if (term.name == "improbable_shape") return "by the improbable shape of the likeliest cause";
  if (term.name == "further_faults") return "by the faults after the first";
  if (term.name == "drift") return "by what a current that drifts may hide";
  if (term.name == "waves") return "by what waves may hide";
  if (term.name == "spells") return "by what spells may hide";
  return "by " + term.name;
}

std::string SignedText(double log_odds) {
  return (log_odds < 0.0 ? "" : "+") + Fixed(log_odds, 1);
}

}  // namespace

std::string Listed(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text.append(text.empty() ? "" : ", ").append(name);
  return text;
}

std::string_view VerdictText(Verdict verdict) {
  switch (verdict) {
    case Verdict::kUnknown: return "Not diagnosed";
    case Verdict::kNoMaterialGap: return "No material gap";
    case Verdict::kExplained: return "Explained";
    case Verdict::kPartlyExplained: return "Partly explained";
    case Verdict::kUnknownCause: return "Cause unknown";
    case Verdict::kInsufficientData: return "Not enough data";
  }
  return "";
}

std::string_view VerdictMeaning(Verdict verdict) {
  switch (verdict) {
    case Verdict::kUnknown: return "";
    case Verdict::kNoMaterialGap:
      return "The model's error on this recording is no larger than on a nominal one.";
    case Verdict::kExplained:
      return "The named effect brings the error back to that of a nominal recording.";
    case Verdict::kPartlyExplained:
      return "The named effect explains part of the excess error; the cause of the rest is not "
             "known.";
    case Verdict::kUnknownCause:
      return "There is a gap, and no effect of the library explains it with certainty.";
    case Verdict::kInsufficientData: return "The recording can neither show nor rule out a gap.";
  }
  return "";
}

std::string_view ChannelText(Equation channel) {
  switch (channel) {
    case Equation::kUnknown: return "all";
    case Equation::kSurge: return "along";
    case Equation::kSway: return "across";
    case Equation::kYaw: return "heading";
  }
  return "";
}

std::string_view KindText(GapKind kind) {
  switch (kind) {
    case GapKind::kUnknown: return "–";
    case GapKind::kBias: return "offset";
    case GapKind::kSlope: return "proportional";
    case GapKind::kTiming: return "timing";
    case GapKind::kNoise: return "noise";
  }
  return "";
}

std::string_view RegionText(PropellerRegion region) {
  switch (region) {
    case PropellerRegion::kFF: return "both forward";
    case PropellerRegion::kFR: return "port forward, starboard reverse";
    case PropellerRegion::kRF: return "port reverse, starboard forward";
    case PropellerRegion::kRR: return "both reverse";
  }
  return "";
}

std::string PlaceText(const GapCell& cell) {
  std::string text(ChannelText(cell.channel));
  if (cell.region) text.append(", ").append(Name(*cell.region));
  if (!cell.bin.empty()) text.append(", ").append(cell.bin);
  return text;
}

std::span<const GapCell> ListedCells(const Diagnosis& diagnosis) {
  constexpr std::size_t kMost = 12;
  return std::span(diagnosis.where).first(std::min(diagnosis.where.size(), kMost));
}

std::string MoreCellsText(const Diagnosis& diagnosis) {
  const std::size_t hidden = diagnosis.where.size() - ListedCells(diagnosis).size();
  if (hidden == 0) return "";
  return Counted(hidden, "more operating condition stands out",
                 "more operating conditions stand out") +
         "; report.json has them all.";
}

std::string TestabilityText(const EffectTestability& effect) {
  switch (effect.testability) {
    case Testability::kUnknown: return "–";
    case Testability::kTestable: return "testable";
    case Testability::kMasked:
      return "masked" + (effect.masked_by.empty() ? "" : " by " + effect.masked_by);
    case Testability::kNotExcited: return "not excited";
  }
  return "";
}

std::string DetectableText(const EffectTestability& effect) {
  std::string text;
  for (const auto& [parameter, size, unit] : effect.detectable_sizes) {
    text.append(text.empty() ? "" : ", ").append(parameter).append(" ");
    text += size ? Significant(*size, 2) + (unit == "1" ? "" : ' ' + unit) : "beyond range";
  }
  return text;
}

std::string BesideWeatherText(const Diagnosis& diagnosis) {
  const std::vector<std::string>& names = diagnosis.present_weather;
  return names.empty() ? "" : " and the " + Enumerated(names) + " of this recording";
}

std::string_view DelayedChannelText(DelayedChannel channel) {
  switch (channel) {
    case DelayedChannel::kUnknown: return "";
    case DelayedChannel::kCommands: return "commands";
    case DelayedChannel::kFixes: return "positions";
  }
  return "";
}

std::string DelayText(const DelayDifference& delay) {
  constexpr double kLevel = 0.95;
  const double half_width_s = NormalInterval(0.0, delay.standard_deviation_s, kLevel).upper;
  return Fixed(delay.difference_s, 2) + " ± " + Fixed(half_width_s, 2) + " s";
}

std::string DetectableText(const DelayDifference& delay) {
  return delay.detectable_s ? Fixed(*delay.detectable_s, 2) + " s" : "beyond range";
}

std::string_view ForceText(std::size_t component) {
  constexpr std::array<std::string_view, 3> kForces = {"surge force, N", "sway force, N",
                                                       "yaw moment, N m"};
  return kForces.at(component);
}

std::string_view VariableText(ForceVariable variable) {
  switch (variable) {
    case ForceVariable::kUnknown: return "";
    case ForceVariable::kSpeed: return "speed ahead, m/s";
    case ForceVariable::kMeanCommand: return "mean command, share of full";
    case ForceVariable::kCommandDifference: return "port less starboard command";
    case ForceVariable::kHeading: return "heading, degrees";
    case ForceVariable::kTime: return "time since the start, s";
  }
  return "";
}

std::string BinEndText(const ForceBin& bin, double end) {
  const double width = bin.high - bin.low;
  return Fixed(end, width >= 5.0 ? 0 : width >= 0.5 ? 1 : 2);
}

std::string PromiseText(const SeparationAdvice& advice) {
  if (advice.separates.empty()) return "would show what kind of cause it is";
  std::string separates;
  for (const std::string& effect : advice.separates) {
    separates.append(separates.empty() ? "" : " from ").append(effect);
  }
  return "would separate " + separates + " by " + Fixed(advice.expected_nats, 1) + " nats" +
         (advice.decisive ? ", which should suffice" : ", which may not suffice");
}

std::string CauseText(const Cause& cause) {
  if (cause.effects.empty()) return "unknown";
  std::string text;
  for (const CausalEffect& effect : cause.effects) {
    text.append(text.empty() ? "" : " + ").append(effect.effect);
  }
  return text;
}

std::string UnknownOddsText(const Diagnosis& diagnosis) {
  constexpr double kHardly = 0.05;  // nats, that a decimal does not show
  std::vector<OddsTerm> terms;
  std::ranges::copy_if(diagnosis.unknown_odds, std::back_inserter(terms),
                       [](const OddsTerm& term) { return std::abs(term.log_odds) >= kHardly; });
  std::ranges::sort(terms, std::ranges::greater{}, &OddsTerm::log_odds);
  std::vector<std::string> parts;
  for (const OddsTerm& term : terms) {
    parts.push_back(SignedText(term.log_odds) + ' ' + TermText(term));
  }
  return parts.empty() ? "" : "Its odds, in nats: " + Listed(parts) + '.';
}

std::string InfluenceText(const ReferenceInfluence& influence) {
  std::string text(VerdictText(influence.verdict));
  if (influence.effects.empty()) return text;
  std::string effects;
  for (const std::string& effect : influence.effects) {
    effects.append(effects.empty() ? "" : " + ").append(effect);
  }
  return text + ": " + effects + " (" + ShareText(influence.probability) + ")";
}

std::string OwnGapText(const ReferenceInfluence& influence) {
  return influence.own_gap ? Fixed(*influence.own_gap, 2) : "–";
}

std::vector<std::pair<std::string, std::string>> EstimatesOf(const CausalEffect& effect) {
  std::vector<std::pair<std::string, std::string>> estimates;
  if (effect.size) estimates.emplace_back(effect.size->name, EstimateText(*effect.size));
  if (effect.towards) estimates.emplace_back("towards", DirectionText(*effect.towards));
  for (const ParameterEstimate& parameter : effect.parameters) {
    estimates.emplace_back(parameter.name, EstimateText(parameter));
  }
  return estimates;
}

std::string ExcessExplainedText(const std::optional<ExcessExplained>& excess_explained) {
  if (!excess_explained) return "–";
  return ShareText(excess_explained->share) + " [" +
         Fixed(100.0 * excess_explained->interval.lower, 0) + ", " +
         Fixed(100.0 * excess_explained->interval.upper, 0) + "]";
}

std::string FloorText(const Diagnosis& diagnosis) {
  switch (diagnosis.floor_basis) {
    case FloorBasis::kUnknown: return "The size of the normal error is not known.";
    case FloorBasis::kReferenceLogs:
      return "The normal error is that on " +
             Counted(diagnosis.reference_logs, "reference recording", "reference recordings") +
             " of the same boat.";
    case FloorBasis::kSensorNoise:
      return "Without reference recordings the normal error is the one that sensor noise alone "
             "leaves. "
             "This is too low: waves and wind count as a gap.";
  }
  return "";
}

std::string OnsetText(const Onset& onset, double start_s) {
  return "It began " + Fixed(onset.time_s - start_s, 0) +
         " s after the start (95 %: " + Fixed(onset.earliest_s - start_s, 0) + " to " +
         Fixed(onset.latest_s - start_s, 0) + " s).";
}

}  // namespace telltale
