#include "telltale/client/report/report_page.hpp"

#include <algorithm>
#include <array>

#include "telltale/client/report/diagnosis_text.hpp"
#include "telltale/client/report/markup.hpp"
#include "telltale/client/report/number_text.hpp"
#include "telltale/client/report/pictures.hpp"
#include "telltale/client/report/style.hpp"

namespace telltale {
namespace {

Markup Section(std::string_view title, std::string_view lead, const Markup& content) {
  Markup section = Styled("h2", "", Words(title));
  if (!lead.empty()) section += Styled("p", "soft", Words(lead));
  return Element("section", {}, section + content);
}

Markup Cell(std::string_view text, std::string_view style = "") {
  return Styled("td", style, Words(text));
}

Markup HeaderRow(std::initializer_list<Attribute> titles) {
  Markup heads;
  for (const Attribute& title : titles) {
    heads += Element("th", {{"scope", "col"}, {"class", title.value}}, Words(title.name));
  }
  return Element("thead", {}, Element("tr", {}, heads));
}

// ---- the headline -------------------------------------------------------------------------------

std::string_view BadgeStyle(Verdict verdict) {
  switch (verdict) {
    case Verdict::kNoMaterialGap:
    case Verdict::kExplained: return "badge calm";
    case Verdict::kPartlyExplained:
    case Verdict::kUnknownCause: return "badge alert";
    case Verdict::kInsufficientData:
    case Verdict::kUnknown: break;
  }
  return "badge mute";
}

Markup Headline(const Diagnosis& diagnosis) {
  const std::string kicker = "Model against recording · " + diagnosis.vehicle_id + " · " +
                             Fixed(diagnosis.end_s - diagnosis.start_s, 0) + " s recorded";
  std::string details = FloorText(diagnosis);
  if (diagnosis.onset) details = OnsetText(*diagnosis.onset, diagnosis.start_s) + ' ' + details;
  if (!diagnosis.rest.empty()) {
    details = "What stays unexplained sits in " + diagnosis.rest + ". " + details;
  }
  return Element("header", {},
                 Styled("p", "kicker", Words(kicker)) +
                     Element("h1", {{"id", "headline"}}, Words(diagnosis.sentence)) +
                     Styled("p", "meaning",
                            Styled("span", BadgeStyle(diagnosis.verdict),
                                   Words(VerdictText(diagnosis.verdict))) +
                                Words(VerdictMeaning(diagnosis.verdict))) +
                     Styled("p", "soft", Words(details)));
}

// ---- sections -----------------------------------------------------------------------------------

Markup GapSection(const Diagnosis& diagnosis) {
  return Section("How large the gap is",
                 "Free-run error, times the normal error: 1 is what a nominal recording shows. The "
                 "horizon of five seconds decides. Percentages are the excess error explained, "
                 "with 95 % intervals.",
                 GapBars(diagnosis));
}

Markup OnsetSection(const Diagnosis& diagnosis) {
  return Section("When it shows", "", ErrorOverTime(diagnosis));
}

Markup WhereRow(const GapCell& cell) {
  const std::string details = std::string(KindText(cell.kind)) + ", mean " + Fixed(cell.mean, 1) +
                              " times the normal error, p " + Significant(cell.p_value, 2) + ", " +
                              Counted(cell.windows, "window", "windows");
  return Element("tr", {},
                 Element("td", {}, Words(PlaceText(cell)) + Styled("small", "", Words(details))) +
                     Cell(ShareText(cell.excess_share), "number"));
}

Markup WhereTable(const Diagnosis& diagnosis) {
  if (diagnosis.where.empty()) {
    return Nothing("No operating condition holds more error than chance would put there.");
  }
  Markup rows;
  for (const GapCell& cell : ListedCells(diagnosis)) rows += WhereRow(cell);
  return Element("table", {},
                 HeaderRow({{"Operating condition", ""}, {"Of the excess", "number"}}) +
                     Element("tbody", {}, rows)) +
         Styled("p", "soft", Words(MoreCellsText(diagnosis)));
}

Markup LocationSection(const Diagnosis& diagnosis) {
  const Markup left =
      Styled("div", "", Styled("h3", "", Words("By propellers and speed")) + ErrorMap(diagnosis));
  const Markup right =
      Styled("div", "", Styled("h3", "", Words("By heading")) + HeadingRose(diagnosis));
  return Section(
      "Where it sits",
      "Operating conditions that stand out, corrected for the number of conditions tested.",
      WhereTable(diagnosis) + Styled("div", "halves", left + right));
}

Markup CausesSection(const Diagnosis& diagnosis) {
  return Section("Which effect causes it",
                 "Probabilities are among the effects of the library and the unknown.",
                 CauseCards(diagnosis));
}

Markup MissingForceSection(const Diagnosis& diagnosis) {
  std::string lead =
      "The force and moment that would have to be added to the model's boat, with what the verdict "
      "names, for it to accelerate as the recording does. A fault of a sensor shows as a force "
      "too.";
  if (diagnosis.missing_force) {
    lead +=
        " Forces are for a mass of " + Significant(diagnosis.missing_force->mass_kg, 3) + " kg.";
  }
  return Section("Which force is missing", lead, MissingForceCharts(diagnosis));
}

Markup PathsSection(const Diagnosis& diagnosis) {
  return Section("Paths",
                 "The windows with the largest error, each from its start (circle) to its end.",
                 PathPictures(diagnosis));
}

Markup ScoreRow(std::string_view name, double before, double after) {
  const double change = before > 0.0 ? after / before - 1.0 : 0.0;
  return Element("tr", {},
                 Cell(name) + Cell(Significant(before, 3), "number") +
                     Cell(Significant(after, 3), "number") +
                     Cell((change > 0.0 ? "+" : "") + ShareText(change), "number"));
}

Markup ScoreRows(const FreeRunScores& before, const FreeRunScores& after) {
  constexpr std::array kVelocities = {"surge, m/s", "sway, m/s", "yaw, rad/s"};
  const std::string title =
      Plain(before.horizon_s) + " s ahead, " + Counted(before.windows, "window", "windows");
  Markup rows = Element("tr", {{"class", "group"}},
                        Element("th", {{"colspan", "4"}, {"scope", "rowgroup"}}, Words(title)));
  for (std::size_t i = 0; i < kVelocities.size(); ++i) {
    rows += ScoreRow(kVelocities[i], before.velocity[i].rmse, after.velocity[i].rmse);
  }
  return rows + ScoreRow("position, m", before.position_rmse_m, after.position_rmse_m);
}

Markup ImprovementTable(const Diagnosis& diagnosis) {
  if (!diagnosis.improvement) {
    return Nothing("No effect is likely, so no other model was identified.");
  }
  const auto& [before, after] = *diagnosis.improvement;
  Markup rows;
  for (std::size_t i = 0; i < std::min(before.size(), after.size()); ++i) {
    if (before[i].windows > 0) rows += ScoreRows(before[i], after[i]);
  }
  return Element(
      "table", {},
      HeaderRow(
          {{"Free-run RMSE", ""}, {"Old", "number"}, {"New", "number"}, {"Change", "number"}}) +
          Element("tbody", {}, rows));
}

Markup ImprovementSection(const Diagnosis& diagnosis) {
  return Section("What the model gains",
                 "Identified again with the likely effects and scored on windows that did not take "
                 "part in fitting.",
                 ImprovementTable(diagnosis));
}

/// Those that the recording would show first, the clearest on top.
std::vector<EffectTestability> ByTestability(std::vector<EffectTestability> effects) {
  std::stable_sort(effects.begin(), effects.end(), [](const auto& a, const auto& b) {
    if (a.testability != b.testability) return a.testability < b.testability;
    return a.detectability > b.detectability;
  });
  return effects;
}

Markup TestabilityTable(const Diagnosis& diagnosis) {
  if (diagnosis.effects.empty()) return Nothing("No effect of the library was asked for.");
  Markup rows;
  for (const EffectTestability& effect : ByTestability(diagnosis.effects)) {
    rows += Element(
        "tr", {},
        Element("td", {},
                JoinedName(effect.effect) + Styled("small", "", Words(DetectableText(effect)))) +
            Cell(Fixed(effect.detectability, 1), "number") + Cell(TestabilityText(effect)));
  }
  return Element("table", {},
                 HeaderRow({{"Effect", ""}, {"Std. errors", "number"}, {"On this recording", ""}}) +
                     Element("tbody", {}, rows));
}

Markup TestabilitySection(const Diagnosis& diagnosis) {
  return Section("What this recording could show",
                 "By how many standard errors an effect of typical size would stand out beside the "
                 "model's own coefficients" +
                     BesideWeatherText(diagnosis) +
                     ", and below its name from which size on it would show in 90 % of cases.",
                 TestabilityTable(diagnosis));
}

Markup ReferencesTable(const Diagnosis& diagnosis) {
  if (diagnosis.reference_influence.empty()) {
    return Nothing("It takes two references or more to leave one out.");
  }
  Markup rows;
  for (const ReferenceInfluence& influence : diagnosis.reference_influence) {
    rows += Element("tr", {},
                    Cell(influence.reference) + Cell(InfluenceText(influence)) +
                        Cell(Fixed(influence.gap.before, 2), "number") +
                        Cell(Fixed(influence.gap.floor_limit, 2), "number") +
                        Cell(OwnGapText(influence), "number"));
  }
  return Element("table", {},
                 HeaderRow({{"Without", ""},
                            {"The answer is", ""},
                            {"Gap", "number"},
                            {"95 % below", "number"},
                            {"Its own gap", "number"}}) +
                     Element("tbody", {}, rows));
}

Markup ReferencesSection(const Diagnosis& diagnosis) {
  return Section("What each reference does",
                 "The diagnosis once more without each reference. An answer that changes rests on "
                 "that one recording. Its own gap is what a nominal day shows that took no part.",
                 ReferencesTable(diagnosis));
}

Markup DelaysSection(const Diagnosis& diagnosis) {
  if (diagnosis.delays.empty()) return {};
  Markup rows;
  for (const DelayDifference& delay : diagnosis.delays) {
    const Markup name = Words(DelayedChannelText(delay.channel)) +
                        Styled("small", "", Words(DetectableText(delay)));
    rows += Element("tr", {}, Element("td", {}, name) + Cell(DelayText(delay), "number"));
  }
  return Section(
      "Clocks",
      "By how much later commands act, and positions are stamped, than on the references, with "
      "bounds of 95 %, and below its name from which delay on it would show in 90 % of cases. Each "
      "recording shows its delays by itself; a free run on a straight course does not.",
      Element("table", {},
              HeaderRow({{"Channel", ""}, {"Later by", "number"}}) + Element("tbody", {}, rows)));
}

Markup AdviceCard(const SeparationAdvice& advice) {
  Markup card = Styled("header", "",
                       Styled("h3", "", Words(advice.manoeuvre)) +
                           Styled("b", "share", Words(Fixed(advice.duration_s, 0) + " s")));
  if (!advice.how.empty()) card += Element("p", {}, Words(advice.how));
  return Styled("article", "card",
                card + Styled("p", "soft", Words("It " + PromiseText(advice) + '.')));
}

Markup AdviceSection(const Diagnosis& diagnosis) {
  Markup cards;
  for (const SeparationAdvice& advice : diagnosis.advice) cards += AdviceCard(advice);
  return Section(
      "Recommended manoeuvres", "",
      diagnosis.advice.empty()
          ? Nothing("No effects are left that a manoeuvre of the catalogue would separate.")
          : Styled("div", "cards", cards));
}

Markup NotesSection(const Diagnosis& diagnosis) {
  Markup items;
  for (const std::string& note : diagnosis.notes) items += Element("li", {}, Words(note));
  return Section("Notes", "",
                 diagnosis.notes.empty() ? Nothing("Nothing else limits the answer.")
                                         : Element("ul", {}, items));
}

/// "2026-05-01 10:00:00 to 2026-05-01 10:07:00 UTC" of a clock that shows the date, else seconds.
std::string SpanText(double start_s, double end_s) {
  constexpr double kYear2001S = 978307200.0;
  if (start_s < kYear2001S) {
    return "from " + Fixed(start_s, 0) + " s to " + Fixed(end_s, 0) + " s of its own clock";
  }
  return UtcText(start_s) + " to " + UtcText(end_s) + " UTC, by its own clock";
}

Markup SourceRow(std::string_view name, const std::string& text) {
  if (text.empty()) return {};
  return Element("tr", {}, Element("th", {{"scope", "row"}}, Words(name)) + Cell(text));
}

Markup ProvenanceSection(const Diagnosis& diagnosis, const ReportSources& sources) {
  const std::string published =
      sources.published_unix_s ? UtcText(*sources.published_unix_s) + " UTC" : "";
  return Section(
      "Where it comes from", "",
      Element("table", {},
              Element("tbody", {},
                      SourceRow("Recording", Listed(sources.recordings)) +
                          SourceRow("Time", SpanText(diagnosis.start_s, diagnosis.end_s)) +
                          SourceRow("Model", sources.model) +
                          SourceRow("References", Listed(sources.references)) +
                          SourceRow("Published", published) +
                          SourceRow("Made by", "Telltale " + diagnosis.software_version +
                                                   ", seed " + std::to_string(diagnosis.seed)))));
}

}  // namespace

ReportSources SourcesOf(const PublishedDiagnosis& diagnosis) {
  return {{"the daemon's window of " + diagnosis.diagnosis.vehicle_id},
          {},
          "revision " + std::to_string(diagnosis.model_revision),
          diagnosis.published_unix_s};
}

std::string ReportPage(const Diagnosis& diagnosis, const ReportSources& sources) {
  const Markup body = Element(
      "main", {},
      Headline(diagnosis) + GapSection(diagnosis) + OnsetSection(diagnosis) +
          LocationSection(diagnosis) + CausesSection(diagnosis) + MissingForceSection(diagnosis) +
          PathsSection(diagnosis) + ImprovementSection(diagnosis) + TestabilitySection(diagnosis) +
          ReferencesSection(diagnosis) + DelaysSection(diagnosis) + AdviceSection(diagnosis) +
          NotesSection(diagnosis) + ProvenanceSection(diagnosis, sources));
  const Markup head = Markup::Own(
                          "<meta charset=\"utf-8\">"
                          "<meta name=\"viewport\" "
                          "content=\"width=device-width, initial-scale=1\">") +
                      Element("title", {}, Words("Diagnosis of " + diagnosis.vehicle_id)) +
                      Element("style", {}, Markup::Own(Style()));
  const Markup page =
      Element("html", {{"lang", "en"}}, Element("head", {}, head) + Element("body", {}, body));
  return "<!DOCTYPE html>\n" + page.Text() + '\n';
}

}  // namespace telltale
