#include "telltale/client/cli/diagnosis_table.hpp"

#include <algorithm>
#include <array>

#include "telltale/client/cli/table.hpp"
#include "telltale/client/report/diagnosis_text.hpp"

namespace telltale {
namespace {

std::string Titled(const std::string& title, const std::string& text) {
  return text.empty() ? "" : '\n' + title + '\n' + text;
}

std::string Headline(const Diagnosis& diagnosis) {
  std::string recording =
      diagnosis.vehicle_id + ", " + Fixed(diagnosis.end_s - diagnosis.start_s, 0) + " s recorded.";
  if (diagnosis.onset) recording += ' ' + OnsetText(*diagnosis.onset, diagnosis.start_s);
  if (!diagnosis.rest.empty())
    recording += " What stays unexplained sits in " + diagnosis.rest + '.';
  return Wrapped(diagnosis.sentence) + '\n' +
         Wrapped(std::string(VerdictText(diagnosis.verdict)) + ": " +
                 std::string(VerdictMeaning(diagnosis.verdict))) +
         Wrapped(recording) + Wrapped(FloorText(diagnosis));
}

std::vector<std::string> GapRow(std::string_view channel, const GapSize& size,
                                const std::optional<ExcessExplained>& excess_explained) {
  return {"  " + std::string(channel), Fixed(size.before, 2),
          Fixed(size.after, 2),        Fixed(size.noise_floor, 2),
          Fixed(size.floor_limit, 2),  ExcessExplainedText(excess_explained)};
}

std::string GapTable(const Diagnosis& diagnosis) {
  Table table({{"times the normal error", Align::kLeft},
               {"before", Align::kRight},
               {"after", Align::kRight},
               {"floor", Align::kRight},
               {"95 % below", Align::kRight},
               {"explained [95 %]", Align::kRight}});
  for (const Gap& gap : diagnosis.gaps) {
    table.AddHeading(Plain(gap.horizon_s) + " s: " + Counted(gap.windows, "window", "windows"));
    if (gap.windows == 0) continue;
    table.AddRow(GapRow("all", gap.all, gap.excess_explained));
    for (const Equation channel : kEquations) {
      const std::size_t i = IndexOf(channel);
      table.AddRow(GapRow(ChannelText(channel), gap.channels[i], gap.channel_excess_explained[i]));
    }
  }
  return table.Render();
}

std::string WhereTable(const Diagnosis& diagnosis) {
  if (diagnosis.where.empty()) return Wrapped("Where: no operating condition stands out.");
  Table table({{"where", Align::kLeft},
               {"excess", Align::kRight},
               {"p", Align::kRight},
               {"kind", Align::kLeft},
               {"mean", Align::kRight},
               {"windows", Align::kRight}});
  for (const GapCell& cell : ListedCells(diagnosis)) {
    table.AddRow({PlaceText(cell), ShareText(cell.excess_share), Significant(cell.p_value, 2),
                  std::string(KindText(cell.kind)), Fixed(cell.mean, 2),
                  std::to_string(cell.windows)});
  }
  return table.Render() + Wrapped(MoreCellsText(diagnosis));
}

std::string EffectText(const CausalEffect& effect, bool several) {
  std::string sentence = effect.sentence;
  if (several) sentence += " (" + ShareText(effect.shapley_share) + " of what these explain)";
  std::string text = effect.sentence.empty() ? "" : Wrapped(sentence, "  ");
  for (const auto& [name, estimate] : EstimatesOf(effect)) {
    text.append("    ").append(name).append("  ").append(estimate).append("\n");
  }
  return text;
}

/// "thruster_lag: probability 81 %, excess explained 74 % [60, 88]", then its effects.
std::string CauseParagraph(const Cause& cause, const Diagnosis& diagnosis) {
  std::string headline = CauseText(cause) + ": probability " + ShareText(cause.probability);
  if (!cause.effects.empty()) {
    headline += ", excess explained [95 %] " + ExcessExplainedText(cause.excess_explained);
  }
  std::string text = Wrapped(headline);
  if (cause.effects.empty()) text += Wrapped(UnknownOddsText(diagnosis), "  ");
  for (const CausalEffect& effect : cause.effects) {
    text += EffectText(effect, cause.effects.size() > 1);
  }
  if (!cause.indistinguishable.empty()) {
    text +=
        Wrapped("this recording cannot separate it from " + Listed(cause.indistinguishable), "  ");
  }
  return text;
}

std::string CausesText(const Diagnosis& diagnosis) {
  if (diagnosis.causes.empty()) return Wrapped("Causes: nothing to explain.");
  std::string text = "Causes\n";
  for (const Cause& cause : diagnosis.causes) text += CauseParagraph(cause, diagnosis);
  return text;
}

std::string TestabilityTable(const Diagnosis& diagnosis) {
  if (diagnosis.effects.empty()) return "";
  Table table({{"effect of typical size", Align::kLeft},
               {"std. errors", Align::kRight},
               {"", Align::kLeft}});
  Table sizes({{"effect", Align::kLeft}, {"shows in 90 % of cases from", Align::kLeft}});
  for (const EffectTestability& effect : diagnosis.effects) {
    table.AddRow({effect.effect, Fixed(effect.detectability, 1), TestabilityText(effect)});
    if (!effect.detectable_sizes.empty()) sizes.AddRow({effect.effect, DetectableText(effect)});
  }
  return Wrapped(
             "By how many standard errors an effect would show beside the model's coefficients" +
                 BesideWeatherText(diagnosis) + ":",
             "") +
         table.Render() + '\n' + sizes.Render();
}

std::string ReferencesTable(const Diagnosis& diagnosis) {
  if (diagnosis.reference_influence.empty()) return "";
  Table table({{"without", Align::kLeft},
               {"before", Align::kRight},
               {"95 % below", Align::kRight},
               {"its own gap", Align::kRight},
               {"verdict", Align::kLeft}});
  for (const ReferenceInfluence& influence : diagnosis.reference_influence) {
    table.AddRow({influence.reference, Fixed(influence.gap.before, 2),
                  Fixed(influence.gap.floor_limit, 2), OwnGapText(influence),
                  InfluenceText(influence)});
  }
  return '\n' + table.Render();
}

std::string DelaysTable(const Diagnosis& diagnosis) {
  if (diagnosis.delays.empty()) return "";
  Table table({{"later than on the references", Align::kLeft},
               {"by", Align::kRight},
               {"shows in 90 % of cases from", Align::kRight}});
  for (const DelayDifference& delay : diagnosis.delays) {
    table.AddRow(
        {std::string(DelayedChannelText(delay.channel)), DelayText(delay), DetectableText(delay)});
  }
  return '\n' + table.Render();
}

/// The profile of the missing force that holds the most of any of its components.
const ForceProfile* TellingProfile(const MissingForce& missing) {
  const auto most = [](const ForceProfile& profile) {
    return *std::max_element(profile.share.begin(), profile.share.end());
  };
  const auto telling = std::max_element(
      missing.over.begin(), missing.over.end(),
      [&](const ForceProfile& a, const ForceProfile& b) { return most(a) < most(b); });
  return telling == missing.over.end() || telling->bins.empty() ? nullptr : &*telling;
}

std::string MissingForceTable(const Diagnosis& diagnosis) {
  if (!diagnosis.missing_force) return "";
  const MissingForce& missing = *diagnosis.missing_force;
  const std::string mass = Significant(missing.mass_kg, 3) + " kg";
  const std::string lead =
      Wrapped("Missing is " + missing.sentence + ", for a mass of " + mass + ".");
  const ForceProfile* const profile = TellingProfile(missing);
  if (profile == nullptr) return '\n' + lead;
  Table table({{std::string(VariableText(profile->variable)), Align::kLeft},
               {std::string(ForceText(0)), Align::kRight},
               {std::string(ForceText(1)), Align::kRight},
               {std::string(ForceText(2)), Align::kRight}});
  for (const ForceBin& bin : profile->bins) {
    std::vector<std::string> row = {BinEndText(bin, bin.low) + " to " + BinEndText(bin, bin.high)};
    for (const ForceMean& force : bin.force) {
      row.push_back(Fixed(force.mean, 2) + " ± " + Fixed(force.half_width, 2));
    }
    table.AddRow(row);
  }
  return '\n' + lead + table.Render();
}

std::string AdviceText(const Diagnosis& diagnosis) {
  std::string text;
  for (const SeparationAdvice& advice : diagnosis.advice) {
    text += Wrapped(
        advice.manoeuvre + " for " + Fixed(advice.duration_s, 0) + " s " + PromiseText(advice),
        "  ");
    if (!advice.how.empty()) text += Wrapped("-> " + advice.how, "     ");
  }
  return Titled("Recommended manoeuvres, by simulation", text);
}

void AddScores(Table& table, const FreeRunScores& before, const FreeRunScores& after) {
  constexpr std::array kVelocities = {"surge u, m/s", "sway v, m/s", "yaw r, rad/s"};
  table.AddHeading(Plain(before.horizon_s) + " s: " + Counted(before.windows, "window", "windows"));
  for (std::size_t i = 0; i < kVelocities.size(); ++i) {
    const FreeRunScore& old = before.velocity[i];
    table.AddRow({std::string("  ") + kVelocities[i], Significant(old.rmse, 3),
                  Significant(after.velocity[i].rmse, 3), Significant(old.noise_floor, 3)});
  }
  table.AddRow({"  position, m", Significant(before.position_rmse_m, 3),
                Significant(after.position_rmse_m, 3), ""});
}

std::string ImprovementTable(const Diagnosis& diagnosis) {
  if (!diagnosis.improvement) return "";
  const auto& [before, after] = *diagnosis.improvement;
  Table table({{"free-run RMSE on held-out windows", Align::kLeft},
               {"old model", Align::kRight},
               {"with the effects", Align::kRight},
               {"noise floor", Align::kRight}});
  for (std::size_t i = 0; i < std::min(before.size(), after.size()); ++i) {
    if (before[i].windows > 0) AddScores(table, before[i], after[i]);
  }
  return '\n' + table.Render();
}

std::string NotesText(const Diagnosis& diagnosis) {
  std::string text;
  for (const std::string& note : diagnosis.notes) text += Wrapped("- " + note, "  ");
  return Titled("Notes", text);
}

}  // namespace

std::string DiagnosisTable(const Diagnosis& diagnosis) {
  return Headline(diagnosis) + '\n' + GapTable(diagnosis) + '\n' + WhereTable(diagnosis) + '\n' +
         CausesText(diagnosis) + MissingForceTable(diagnosis) + ImprovementTable(diagnosis) +
         ReferencesTable(diagnosis) + DelaysTable(diagnosis) + TestabilityTable(diagnosis) +
         AdviceText(diagnosis) + NotesText(diagnosis);
}

}  // namespace telltale
