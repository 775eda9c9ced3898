#include "telltale/client/report/report_page.hpp"

#include <cmath>
#include <cstdlib>
#include <limits>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/browser.hpp"
#include "support/made_up_diagnoses.hpp"
#include "telltale/client/report/diagnosis_text.hpp"
#include "telltale/core/diagnosis/hypotheses/ranking.hpp"
#include "telltale/core/effects/effect.hpp"
#include "telltale/idl/codec/json/report.hpp"

namespace telltale {
namespace {

using testing::HasSubstr;
using testing::Not;

/// What a reader sees, by and large: the page without its tags and style.
std::string TextOfPage(const std::string& page) {
  const std::string body = page.substr(page.find("<body"));
  const std::string joined = std::regex_replace(body, std::regex("<wbr>"), "");
  return std::regex_replace(joined, std::regex("<[^>]*>"), " ");
}

std::size_t CountOf(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

TEST(Page, SaysTheSentenceTheVerdictAndEveryPart) {
  const Diagnosis made = MadeUpDiagnosis();
  const std::string page = ReportPage(made);
  EXPECT_THAT(page, HasSubstr("<h1 id=\"headline\">" + made.sentence + "</h1>"));
  const std::string text = TextOfPage(page);
  for (const char* part : {"Partly explained",
                           "made-up.1",
                           "400 s recorded",
                           "3 reference recordings",
                           "205 s after the start",
                           "81 % [74, 87]",
                           "heading, FF, 0.5 to 1.0 m/s",
                           "44 %",
                           "proportional",
                           "thruster_imbalance + thruster_lag",
                           "81 %",
                           "port thruster 22 % weaker",
                           "0.220 ± 0.030",
                           "0.150 ± 0.035 s",
                           "cannot separate it from thruster_delay",
                           "unknown",
                           "masked by YAW uv",
                           "own coefficients and the wind of this recording, and",
                           "not excited",
                           "fast random steps",
                           "7.2 nats",
                           "Which force is missing",
                           "a surge force that is -4.0 ± 0.8 N on headings of 0 to 36 deg",
                           "for a mass of 15.0 kg",
                           "Over heading, degrees",
                           "coast-down",
                           "the wind was not measured",
                           "seed 18446744073709551615"}) {
    EXPECT_THAT(text, HasSubstr(part));
  }
}

TEST(Page, SaysInWordsWhereThereIsNothing) {
  const std::string text = TextOfPage(ReportPage(MadeUpNominalDiagnosis()));
  for (const char* part :
       {"No material gap", "sensor noise alone", "No operating condition", "no gap that would ask",
        "No windows were kept to draw over time", "No windows were kept to sort by heading",
        "No paths were kept", "Nothing stays unexplained", "No effect is likely",
        "No effects are left", "Nothing else limits the answer"}) {
    EXPECT_THAT(text, HasSubstr(part));
  }
}

TEST(Page, DrawsAnAfterOnlyWhereThereIsOne) {
  Diagnosis made = MadeUpDiagnosis();
  for (Gap& gap : made.gaps) gap.all.after = gap.all.before;
  const std::string body = ReportPage(made).substr(ReportPage(made).find("<body"));
  EXPECT_THAT(body, Not(HasSubstr("after-")));
  EXPECT_THAT(body, HasSubstr("before-dot"));
}

TEST(Page, SaysWhereItComesFrom) {
  const std::string text = std::regex_replace(
      TextOfPage(ReportPage(MadeUpDiagnosis(),
                            {{"today", "tonight"}, {"monday"}, "boat.json", 1700001000.0})),
      std::regex("\\s+"), " ");
  // date -u -d @1700000000: Tue Nov 14 22:13:20 UTC 2023
  EXPECT_THAT(text, HasSubstr("Recording today, tonight Time 2023-11-14 22:13:20 to 2023-11-14 "
                              "22:20:00 UTC, by its own clock Model boat.json References monday "
                              "Published 2023-11-14 22:30:00 UTC Made by Telltale"));
  Diagnosis made = MadeUpDiagnosis();
  made.start_s = 300.0;
  made.end_s = 900.0;
  const std::string other = TextOfPage(ReportPage(made, SourcesOf({made, 7, 1700001000.0})));
  EXPECT_THAT(other, HasSubstr("from 300 s to 900 s of its own clock"));
  EXPECT_THAT(other, HasSubstr("revision 7"));
  EXPECT_THAT(other, Not(HasSubstr("References")));
}

TEST(Page, GivesNoCardToACauseThatIsUnlikely) {
  Diagnosis made = MadeUpDiagnosis();
  made.causes.back().probability = 0.0;
  const std::string page = ReportPage(made);
  EXPECT_THAT(page, HasSubstr("Unlikely: unknown 0 %."));
  EXPECT_THAT(page, Not(HasSubstr("Something that the library of effects lacks.")));
}

// Every term that core names has words.
TEST(UnknownOddsText, NamesEveryTermInWords) {
  Diagnosis made;
  made.unknown_odds = UnknownOdds({.before = 3.0, .after = 2.0, .nominal = 1.0, .median = 1.5}, {});
  ASSERT_FALSE(made.unknown_odds.empty());
  for (OddsTerm& term : made.unknown_odds) term.log_odds = 1.0;
  EXPECT_THAT(UnknownOddsText(made), Not(HasSubstr("_")));
  for (const OddsTerm& term : made.unknown_odds) {
    EXPECT_THAT(UnknownOddsText(made), Not(HasSubstr("by " + term.name + ","))) << term.name;
  }
}

TEST(Page, SaysWhyAnUnknownCauseIsLikely) {
  Diagnosis made = MadeUpDiagnosis();
  made.causes.back().probability = 0.5;
  made.unknown_odds.push_back({"a_term_of_later_versions", 1.0, 7.0});
  const std::string page = ReportPage(made);
  EXPECT_THAT(page, HasSubstr("Its odds, in nats: +7.0 by a_term_of_later_versions, +0.4 by what"));
}

TEST(Page, ShowsByHowMuchEachChannelIsLater) {
  const std::string page = ReportPage(MadeUpDiagnosis());
  EXPECT_THAT(page,
              HasSubstr("commands<small>0.75 s</small></td><td class=\"number\">-0.06 ± 0.24 s"));
  EXPECT_THAT(
      page,
      HasSubstr("positions<small>beyond range</small></td><td class=\"number\">0.38 ± 0.12 s"));
}

TEST(Page, LeavesClocksOutThatNoModelCompares) {
  Diagnosis made = MadeUpDiagnosis();
  made.delays.clear();
  EXPECT_THAT(ReportPage(made), Not(HasSubstr("Clocks")));
}

TEST(Page, ShowsTheValuesOfAWindowUnderThePointer) {
  Diagnosis made = MadeUpDiagnosis();
  made.pictures[1].time_s = made.start_s + 125.0;
  made.pictures[1].before = 3.25;
  made.pictures[1].after = 1.125;
  EXPECT_THAT(ReportPage(made), HasSubstr("<title>125 s: 3.2 before, 1.1 after, times the normal "
                                          "error</title><rect class=\"pointed\""));
}

TEST(Page, TheMapHoldsRootMeanSquaresByRegionAndSpeed) {
  Diagnosis made = MadeUpNominalDiagnosis();
  made.gaps[0].all.after = 0.5;
  const auto window = [](double before, double after, double speed, PropellerRegion region) {
    WindowPicture picture;
    picture.before = before;
    picture.after = after;
    picture.speed_m_s = speed;
    picture.region = region;
    return picture;
  };
  made.pictures = {window(3.0, 1.0, 0.25, PropellerRegion::kFR),
                   window(4.0, 1.0, 0.375, PropellerRegion::kFR),
                   window(2.0, 1.5, 1.75, PropellerRegion::kRR)};
  const std::string text =
      std::regex_replace(TextOfPage(ReportPage(made)), std::regex("\\s+"), " ");
  // sqrt((9 + 16) / 2) = 3.54; speeds to 1.75 m/s in steps of 0.5.
  EXPECT_THAT(text, HasSubstr("0–0.5 – 3.5 → 1.0 n 2 – – 1.5–2 – – – 2.0 → 1.5 n 1 "));
  EXPECT_THAT(ReportPage(made),
              HasSubstr("times the normal error: N 3.1 before, 1.2 after; NE no data"));
}

TEST(Page, EveryStringIsEscaped) {
  const std::string hostile = "</style><script>alert('x')</script>\"&<b>";
  Diagnosis made = MadeUpDiagnosis();
  made.vehicle_id = made.sentence = made.rest = made.software_version = hostile;
  made.notes = {hostile};
  made.missing_force->sentence = hostile;
  for (GapCell& cell : made.where) cell.bin = hostile;
  for (Cause& cause : made.causes) {
    cause.indistinguishable = {hostile};
    for (CausalEffect& effect : cause.effects) {
      effect.effect = effect.sentence = hostile;
      for (ParameterEstimate& parameter : effect.parameters)
        parameter.name = parameter.unit = hostile;
    }
  }
  for (EffectTestability& effect : made.effects) effect.effect = effect.masked_by = hostile;
  made.present_weather = {hostile};
  for (SeparationAdvice& advice : made.advice) {
    advice.manoeuvre = advice.how = hostile;
    advice.separates = {hostile};
  }
  const std::string page = ReportPage(made);
  EXPECT_THAT(page, Not(HasSubstr("<script")));
  EXPECT_THAT(page, Not(HasSubstr("<b>\"")));
  EXPECT_THAT(page,
              HasSubstr("&lt;script&gt;alert(&#39;x&#39;)&lt;/script&gt;&quot;&amp;&lt;b&gt;"));
  EXPECT_EQ(CountOf(page, "</style>"), 1u);
}

TEST(Page, AsksForNothingFromOutside) {
  const std::string page = ReportPage(MadeUpDiagnosis());
  for (const char* way : {"http:", "https:", "//", "src=", "href=", "url(", "@import", "<script",
                          "<link", "<iframe", "<img", "<object"}) {
    EXPECT_THAT(page, Not(HasSubstr(way)));
  }
}

TEST(Page, DivergedModelsAreDrawnAtTheEdge) {
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  Diagnosis made = MadeUpDiagnosis();
  for (std::size_t i = 0; i < made.pictures.size(); i += 3) {
    made.pictures[i].before = kInfinite;
    made.pictures[i].predicted_before.back() = {kInfinite, std::nan("")};
    made.pictures[i].predicted_before[10] = {1e12, 1e12};
  }
  made.gaps[1].all.before = kInfinite;
  made.causes[0].effects[0].parameters[0].standard_error = kInfinite;
  const std::string page = ReportPage(made);
  const std::regex bad_attribute("=\"[^\"]*\\b(nan|inf|-?[0-9]{7,})[^\"]*\"", std::regex::icase);
  const std::string body = page.substr(page.find("<body"));
  EXPECT_FALSE(std::regex_search(body, bad_attribute));
  EXPECT_THAT(body, HasSubstr("∞"));
}

TEST(Page, AStoredReportDrawsTheSamePage) {
  const Diagnosis made = MadeUpDiagnosis();
  const auto stored = ParseReportJson(PrintReportJson(made));
  ASSERT_TRUE(stored) << stored.error().Message();
  EXPECT_EQ(ReportPage(*stored), ReportPage(made));
}

// ---- in a real browser --------------------------------------------------------------------------

/// Measures the page from inside and tells its parent: the width, what reaches beyond it, and text
/// smaller than 14 px as it is drawn.
constexpr const char* kMeasure = R"(<script>
addEventListener('load', () => {
  const width = document.documentElement.clientWidth;
  const shown = [...document.body.querySelectorAll('*')].filter(e => e.getClientRects().length);
  const name = e => e.tagName + '.' + (e.getAttribute('class') || '');
  const wide = shown.filter(e => {
    const box = e.getBoundingClientRect();
    return !e.closest('svg svg, svg *') && (box.right > width + 0.5 || box.left < -0.5);
  }).map(name);
  const size = e => parseFloat(getComputedStyle(e).fontSize) *
      (e.tagName === 'text' ? e.getScreenCTM().a : 1);
  const small = shown.filter(e => [...e.childNodes].some(n => n.nodeType === 3 && n.data.trim()))
      .filter(e => size(e) < 13.95).map(e => name(e) + ' ' + size(e).toFixed(1));
  parent.postMessage('width ' + width + '; wide: ' + wide + '; small: ' + small +
      '; scroll ' + document.documentElement.scrollWidth +
      '; headline: ' + document.getElementById('headline').innerText, '*');
});
</script>)";

/// What kMeasure says at each of the widths. Headless Chromium makes no window below 500 px, but
/// frames can be narrower.
std::vector<std::string> Measured(const std::filesystem::path& browser, const std::string& page,
                                  const std::vector<int>& widths) {
  const TemporaryFolder folder;
  folder.Write("page.html", page + kMeasure);
  std::string frames =
      "<!DOCTYPE html><body><pre id=\"said\"></pre><script>"
      "addEventListener('message', e => { document.getElementById('said').textContent += "
      "e.data + '\\n'; });</script>";
  for (const int width : widths) {
    frames += "<iframe src=\"page.html\" style=\"display:block;border:0;height:800px;width:" +
              std::to_string(width) + "px\"></iframe>";
  }
  std::string document = DocumentInBrowser(browser, folder.Write("frames.html", frames));
  document = document.substr(0, document.find("</pre>"));
  std::vector<std::string> said;
  std::istringstream lines(document);
  for (std::string line; std::getline(lines, line);) {
    const auto at = line.find("width ");
    if (at != std::string::npos && line.find("; wide: ") != std::string::npos) {
      said.push_back(line.substr(at));
    }
  }
  return said;
}

/// As much as a page can have to hold: every effect, three at once, an hour of windows, a note
/// without a blank in it.
Diagnosis Crowded() {
  Diagnosis made = MadeUpDiagnosis();
  made.effects.clear();
  for (const Effect* effect : EffectLibrary()) {
    made.effects.push_back(
        {std::string(effect->Name()), Testability::kMasked, 123.4, "SURGE mean^2+diff^2/4"});
  }
  Cause& most = made.causes[0];
  most.effects.clear();
  for (const char* name : {"thruster_misalignment", "added_mass_coupling", "thrust_inflow_loss"}) {
    CausalEffect part{name, {}, "", 1.0 / 3.0};
    for (const EffectParameter& parameter : FindEffect(name)->Parameters()) {
      part.parameters.push_back(
          {std::string(parameter.name), -1234.5, 1e-7, std::string(parameter.unit)});
    }
    most.effects.push_back(part);
  }
  made.where[0].bin = "after a step in the last third at headings around north-northeast";
  for (std::size_t i = made.pictures.size(); i < 720; ++i) {
    made.pictures.push_back(MadeUpWindow(i));
  }
  made.end_s = made.start_s + 3600.0;
  made.notes.emplace_back(300, 'm');
  return made;
}

TEST(Page, FitsPhonesAndDesksInARealBrowser) {
  const auto browser = FindBrowser();
  if (!browser) {
    const char* ci = std::getenv("CI");
    ASSERT_STRNE(ci ? ci : "", "true") << "CI has to have Chromium, see deploy/install-deps --ci";
    GTEST_SKIP() << "there is no Chromium on the path, so no page was opened";
  }
  const std::vector<int> widths = {360, 390, 701, 768, 1010, 1280};
  for (const Diagnosis& made : {MadeUpDiagnosis(), MadeUpNominalDiagnosis(), Crowded()}) {
    const auto measured = Measured(*browser, ReportPage(made), widths);
    ASSERT_EQ(measured.size(), widths.size());
    for (const std::string& said : measured) {
      EXPECT_THAT(said, HasSubstr("; wide: ; small: ; "));
      EXPECT_THAT(said, HasSubstr("headline: " + made.sentence));
      std::smatch found;
      ASSERT_TRUE(std::regex_search(said, found, std::regex("width (\\d+);.*; scroll (\\d+);")));
      EXPECT_LE(std::stoi(found[2]), std::stoi(found[1])) << said;
    }
  }
}

}  // namespace
}  // namespace telltale
