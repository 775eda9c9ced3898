#include "score/figures.hpp"
#include "score/confusable.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "score/confusable.hpp"
#include "score/tables.hpp"

namespace blind::score {
namespace {

Cause Named(const EffectSet& effects, double probability, const EffectSet& like = {}) {
  return {.effects = effects,
          .probability = probability,
          .indistinguishable = like,
          .indistinguishable_sets = {},
          .directions = {}};
}

Scored Answer(const std::string& kind, const EffectSet& truth, const std::string& verdict,
              const std::vector<Cause>& causes, double detectability = 20.0) {
  Scored scored{.label = {kind, truth}, .report = {}, .left_out = {}};
  scored.report.verdict = verdict;
  scored.report.causes = causes;
  for (const std::string& effect : truth) scored.report.detectability[effect] = detectability;
  return scored;
}

// R 4.2: binom.test(5, 20)$conf.int and binom.test(1, 10)$conf.int; with no or only hits the bounds
// are 1 - tail^(1/n) and tail^(1/n).
TEST(ClopperPearson, HasTextbookBounds) {
  EXPECT_NEAR(ClopperPearson(5, 20, 0.95).lower, 0.08657147, 1e-7);
  EXPECT_NEAR(ClopperPearson(5, 20, 0.95).upper, 0.49104587, 1e-7);
  EXPECT_NEAR(ClopperPearson(1, 10, 0.95).lower, 0.00252858, 1e-7);
  EXPECT_NEAR(ClopperPearson(1, 10, 0.95).upper, 0.44501612, 1e-7);
  EXPECT_EQ(ClopperPearson(0, 30, 0.95).lower, 0.0);
  EXPECT_NEAR(ClopperPearson(0, 30, 0.95).upper, 1.0 - std::pow(0.025, 1.0 / 30.0), 1e-12);
  EXPECT_NEAR(ClopperPearson(10, 10, 0.95).lower, std::pow(0.025, 1.0 / 10.0), 1e-12);
  EXPECT_EQ(ClopperPearson(10, 10, 0.95).upper, 1.0);
  EXPECT_NEAR(ClopperPearsonUpper(0, 30, 0.95), 1.0 - std::pow(0.05, 1.0 / 30.0), 1e-12);
}

TEST(Brier, IsTheMeanSquaredMiss) {
  EXPECT_NEAR(Brier({{0.9, true}, {0.8, false}}), (0.01 + 0.64) / 2.0, 1e-12);
  EXPECT_EQ(Brier({{1.0, true}, {0.0, false}}), 0.0);
}

TEST(CalibrationError, ComparesWithinBins) {
  // One bin, 0.95 on average, half of it right.
  EXPECT_NEAR(CalibrationError({{0.92, true}, {0.98, false}}), 0.45, 1e-12);
  // Two bins, which do not cancel: (|0.25 - 1| + |0.75 - 0|) / 2.
  EXPECT_NEAR(CalibrationError({{0.25, true}, {0.75, false}}), 0.75, 1e-12);
  EXPECT_NEAR(CalibrationError({{1.0, true}, {1.0, true}}), 0.0, 1e-12);
}

TEST(Figures, CountTop1Top3AndClass) {
  const Figures figures = FiguresOf({
      Answer("single", {"wind"}, "EXPLAINED", {Named({"wind"}, 0.9)}),
      Answer("single", {"wind"}, "EXPLAINED",
             {Named({"current"}, 0.6, {"wind"}), Named({"wind"}, 0.3)}),
      Answer("single", {"wind"}, "PARTLY_EXPLAINED",
             {Named({"payload"}, 0.4), Named({"waves"}, 0.3), Named({"unknown"}, 0.2),
              Named({"wind"}, 0.1)}),
      Answer("single", {"wind"}, "NO_MATERIAL_GAP", {Named({"wind"}, 0.9)}, 3.0),
  });
  EXPECT_EQ(figures.all.top_1.hits, 1u);
  EXPECT_EQ(figures.all.top_3.hits, 2u);
  EXPECT_EQ(figures.all.class_hit.hits, 2u);
  EXPECT_EQ(figures.all.top_1.all, 4u);
  EXPECT_EQ(figures.detectable.top_1.all, 3u) << "one case shows 3 sigmas only";
  EXPECT_THAT(figures.all.class_sizes, testing::ElementsAre(1.0, 2.0, 1.0));
  EXPECT_EQ(figures.forecasts.size(), 3u) << "no gap, no forecast";
  EXPECT_THAT(figures.effects.at("wind").called,
              testing::ElementsAre(std::pair{"NO_MATERIAL_GAP", 1u}, std::pair{"current", 1u},
                                   std::pair{"payload", 1u}, std::pair{"wind", 1u}));
}

TEST(Figures, CountEffectsThatShowAsLargeAsTheyAre) {
  const auto seen = [](double size, double detectability) {
    Scored scored = Answer("single", {"wind"}, "EXPLAINED", {Named({"wind"}, 0.9)}, detectability);
    scored.label.sizes = {{"wind", size}};
    return scored;
  };
  const Figures figures = FiguresOf({seen(0.5, 19.0), seen(0.5, 21.0), seen(2.0, 6.0)});
  EXPECT_EQ(figures.detectable.top_1.all, 2u);
  EXPECT_EQ(figures.detectable_as_it_is.top_1.all, 2u);
}

TEST(Figures, CountFalseAlarms) {
  const Figures figures = FiguresOf({
      Answer("nominal", {}, "NO_MATERIAL_GAP", {}),
      Answer("nominal", {}, "INSUFFICIENT_DATA", {}),
      Answer("nominal", {}, "EXPLAINED", {Named({"wind"}, 0.7)}),
      Answer("nominal", {}, "UNKNOWN_CAUSE", {Named({"unknown"}, 0.9)}),
  });
  EXPECT_EQ(figures.false_alarms.hits, 2u);
  EXPECT_EQ(figures.false_alarms.all, 4u);
  for (const Forecast& forecast : figures.forecasts) EXPECT_FALSE(forecast.right);
  EXPECT_EQ(figures.forecasts.size(), 2u);
}

/// The same answer where this weather is there.
Scored In(const EffectSet& weather, Scored scored) {
  scored.label.weather = weather;
  return scored;
}

TEST(Figures, LetTheWeatherThatIsThereBeNamed) {
  const Figures figures = FiguresOf({
      In({"wind"}, Answer("nominal", {}, "NO_MATERIAL_GAP", {})),
      In({"wind"}, Answer("nominal", {}, "EXPLAINED", {Named({"wind"}, 0.9)})),
      In({"wind"}, Answer("nominal", {}, "EXPLAINED", {Named({"waves"}, 0.9)})),
      In({"wind"}, Answer("nominal", {}, "EXPLAINED", {Named({"wind", "payload"}, 0.9)})),
      In({"wind"}, Answer("nominal", {}, "UNKNOWN_CAUSE", {Named({"unknown"}, 0.9)})),
      In({"wind"}, Answer("single", {"payload"}, "EXPLAINED", {Named({"payload"}, 0.9)})),
      In({"wind"}, Answer("single", {"payload"}, "EXPLAINED", {Named({"wind", "payload"}, 0.9)})),
      In({"wind"}, Answer("single", {"payload"}, "EXPLAINED", {Named({"wind"}, 0.9)})),
      In({"wind"}, Answer("single", {"payload"}, "EXPLAINED", {Named({"waves", "payload"}, 0.9)})),
      In({"wind"}, Answer("outside", {"ship_wash"}, "PARTLY_EXPLAINED", {Named({"wind"}, 0.9)})),
      In({"wind"}, Answer("outside", {"ship_wash"}, "PARTLY_EXPLAINED", {Named({"waves"}, 0.9)})),
      In({"wind"}, Answer("outside", {"ship_wash"}, "EXPLAINED", {Named({"wind"}, 0.9)})),
  });
  EXPECT_EQ(figures.false_alarms.hits, 3u);
  EXPECT_EQ(figures.weather_named.hits, 1u);
  EXPECT_EQ(figures.weather_named.all, 5u);
  EXPECT_EQ(figures.all.top_1.hits, 2u);
  EXPECT_EQ(figures.all.class_hit.hits, 2u);
  EXPECT_EQ(figures.wrongly_named.hits, 2u)
      << "nothing but weather is a full explanation of no stranger";
}

TEST(Figures, CountUnknownsWronglyNamed) {
  const Figures figures = FiguresOf({
      Answer("outside", {"ship_wash"}, "UNKNOWN_CAUSE", {Named({"unknown"}, 0.8)}),
      Answer("outside", {"ship_wash"}, "PARTLY_EXPLAINED", {Named({"waves"}, 0.5)}),
      Answer("outside", {"ship_wash"}, "PARTLY_EXPLAINED", {Named({"waves"}, 0.51)}),
      Answer("outside", {"ship_wash"}, "EXPLAINED", {Named({"waves"}, 0.3)}),
      Answer("outside", {"ship_wash"}, "NO_MATERIAL_GAP", {}),
  });
  EXPECT_EQ(figures.wrongly_named.hits, 2u);
  EXPECT_EQ(figures.wrongly_named.all, 5u);
  EXPECT_EQ(figures.outside_seen.hits, 4u);
  ASSERT_EQ(figures.forecasts.size(), 4u);
  EXPECT_TRUE(figures.forecasts[0].right) << "unknown is the right answer";
  EXPECT_FALSE(figures.forecasts[1].right);
}

TEST(Figures, TakePairsUpToTheirClasses) {
  const EffectSet truth{"thruster_lag", "wind"};
  Cause by_sets = Named({"current", "payload"}, 0.9);
  by_sets.indistinguishable_sets.insert(truth);
  const Figures figures = FiguresOf({
      Answer("pair", truth, "EXPLAINED", {Named(truth, 0.9)}),
      Answer("pair", truth, "EXPLAINED",
             {Named({"thruster_delay", "wind"}, 0.9, {"thruster_lag"})}),
      Answer("pair", truth, "EXPLAINED", {by_sets}),
      Answer("pair", truth, "EXPLAINED", {Named({"wind"}, 0.9)}),
      Answer("pair", truth, "EXPLAINED", {Named({"thruster_lag", "wind", "waves"}, 0.9)}),
      Answer("pair", truth, "UNKNOWN_CAUSE", {Named({"unknown"}, 0.9)}),
  });
  EXPECT_EQ(figures.exact_pairs.hits, 3u);
  EXPECT_EQ(figures.half_pairs.hits, 4u);
  EXPECT_EQ(figures.exact_pairs.all, 6u);
}

TEST(Figures, CompareClosureWhereItWasRealised) {
  Scored first = Answer("single", {"wind"}, "EXPLAINED", {Named({"wind"}, 0.9)});
  first.report.closure = 0.9;
  first.report.realised = 0.8;
  Scored second = first;
  second.report.closure = 0.7;
  second.report.realised.reset();
  Scored likely = Answer("single", {"wind"}, "UNKNOWN_CAUSE", {Named({"wind"}, 0.7)});
  likely.report.closure = 0.8;
  likely.report.realised = 0.3;
  const Figures figures = FiguresOf({first, second, likely});
  ASSERT_EQ(figures.closure_errors.size(), 2u);
  EXPECT_NEAR(figures.closure_errors[0], 0.1, 1e-12);
  EXPECT_NEAR(figures.closure_errors[1], 0.5, 1e-12);
  ASSERT_EQ(figures.named_closure_errors.size(), 1u);
  EXPECT_NEAR(figures.named_closure_errors[0], 0.1, 1e-12);
  EXPECT_NEAR(Median(figures.closures), 0.8, 1e-12);
  EXPECT_EQ(figures.all.class_hit.hits, 3u);
  EXPECT_EQ(figures.all.named_hit.hits, 2u) << "likely, but not named for sure";
}

TEST(Figures, CountWrongNamesGivenWithoutTheTrueEffect) {
  const auto left_out = [](const EffectSet& like, const std::string& verdict, const Cause& cause) {
    Scored scored = Answer("single", {"wind"}, "EXPLAINED",
                           {Named({"wind"}, 0.9, like), Named({"payload"}, 0.1)});
    scored.left_out = Answer("single", {}, verdict, {cause}).report;
    return scored;
  };
  Scored in_waves = left_out({}, "EXPLAINED", Named({"waves"}, 0.9));
  in_waves.label.weather = {"waves"};
  const Figures figures = FiguresOf({
      in_waves,
      left_out({}, "EXPLAINED", Named({"current"}, 0.9)),
      left_out({}, "EXPLAINED", Named({"payload"}, 0.9)),
      left_out({}, "EXPLAINED", Named({"current", "payload"}, 0.9)),
      left_out({"current"}, "EXPLAINED", Named({"current"}, 0.9)),
      left_out({}, "EXPLAINED", Named({"current"}, 0.5)),
      left_out({}, "PARTLY_EXPLAINED", Named({"current"}, 0.9)),
      left_out({}, "UNKNOWN_CAUSE", Named({"unknown"}, 0.9)),
      left_out({}, "NO_MATERIAL_GAP", Named({"current"}, 0.9)),
      Answer("single", {"wind"}, "EXPLAINED", {Named({"current"}, 0.9)}),
  });
  EXPECT_EQ(figures.confidently_wrong.hits, 5u);
  EXPECT_EQ(figures.confidently_wrong.all, 8u) << "a gap has to be seen";
  EXPECT_EQ(figures.unrelated_named.hits, 2u) << "wind and current are known to look alike";
  EXPECT_EQ(figures.unrelated_named.all, 8u);
  EXPECT_EQ(figures.absent_named.hits, 1u) << "the waves are there";
  EXPECT_EQ(figures.indistinguishable_named.hits, 1u);
}

TEST(Confusable, IsAPairWhicheverWayRound) {
  EXPECT_TRUE(AreConfusable("thruster_lag", "thruster_delay"));
  EXPECT_TRUE(AreConfusable("thruster_delay", "thruster_lag"));
  EXPECT_FALSE(AreConfusable("thruster_lag", "payload"));
  EXPECT_FALSE(AreConfusable("payload", "payload"));
}

TEST(Median, IsTheMiddle) {
  EXPECT_EQ(Median({3.0, 1.0, 2.0}), 2.0);
  EXPECT_EQ(Median({4.0, 1.0, 2.0, 3.0}), 2.5);
  EXPECT_TRUE(std::isnan(Median({})));
}

TEST(ParseReport, ReadsWhatTheInterfacesShow) {
  const Report report = ParseReport(R"({
    "verdict": "EXPLAINED", "gap": {"before": 3.1, "closure": 0.81},
    "causes": [
      {"effects": ["thruster_delay"], "probability": 0.2},
      {"effects": ["thruster_lag"], "probability": 0.7, "indistinguishable": ["thruster_delay"]},
      {"effects": ["unknown"], "probability": 0.1}],
    "effects": [{"effect": "thruster_lag", "testability": "TESTABLE", "detectability": 14.5},
                {"effect": "wind", "testability": "NOT_EXCITED"},
                {"effect": "current", "detectability": "Infinity"}]})");
  EXPECT_EQ(report.verdict, "EXPLAINED");
  ASSERT_EQ(report.causes.size(), 3u);
  EXPECT_EQ(report.causes[0].effects, EffectSet{"thruster_lag"}) << "the likeliest first";
  EXPECT_EQ(report.causes[0].indistinguishable, EffectSet{"thruster_delay"});
  EXPECT_EQ(report.detectability.at("thruster_lag"), 14.5);
  EXPECT_EQ(report.detectability.at("wind"), 0.0);
  EXPECT_TRUE(std::isinf(report.detectability.at("current")));
  EXPECT_EQ(report.closure, 0.81);
}

TEST(ParseReport, ReadsTheDirectionsOfWeather) {
  const Report report = ParseReport(R"({"verdict": "EXPLAINED", "causes": [
    {"effects": ["current", "waves", "payload"], "probability": 0.9, "parts": [
      {"effect": "current", "direction": {"halfWidthDeg": 12}},
      {"effect": "waves", "direction": {"towardsDeg": 300, "halfWidthDeg": 20, "orOpposite": true}},
      {"effect": "payload"}]}]})");
  const auto& directions = report.causes.front().directions;
  ASSERT_EQ(directions.size(), 2U);
  EXPECT_EQ(directions.at("current").towards_deg, 0.0);
  EXPECT_EQ(directions.at("waves").half_width_deg, 20.0);
  EXPECT_TRUE(directions.at("waves").or_opposite);
}

TEST(ParseLabel, ReadsHowLargeEffectsAre) {
  const Label label = ParseLabel(R"({"kind": "single",
    "effects": [{"effect": "payload", "size": 0.5}], "weather": [{"effect": "waves"}]})");
  EXPECT_THAT(label.sizes, ::testing::ElementsAre(::testing::Pair("payload", 0.5),
                                                  ::testing::Pair("waves", 1.0)));
}

TEST(ParseLabel, ReadsWhereWeatherRunsTo) {
  const Label label = ParseLabel(R"({"kind": "single",
    "effects": [{"effect": "payload", "parameters": [{"name": "mass", "value": 7}]}],
    "weather": [{"effect": "waves", "parameters": [{"name": "towards", "value": 123.5}]}]})");
  EXPECT_THAT(label.towards_deg, ::testing::ElementsAre(::testing::Pair("waves", 123.5)));
}

TEST(Holds, GoesRoundNorthAndToTheOppositeSide) {
  EXPECT_TRUE(Holds({355.0, 10.0, false}, 4.0));
  EXPECT_FALSE(Holds({355.0, 10.0, false}, 6.0));
  EXPECT_FALSE(Holds({355.0, 10.0, false}, 176.0));
  EXPECT_TRUE(Holds({355.0, 10.0, true}, 176.0));
}

TEST(Figures, CountDirectionsThatAreToldAndThoseThatHold) {
  const auto in_waves = [](const Direction& direction) {
    Cause cause = Named({"waves"}, 0.95);
    cause.directions = {{"waves", direction}, {"current", {0.0, 5.0, false}}};
    Scored scored = Answer("nominal", {}, "EXPLAINED", {cause});
    scored.label.weather = {"waves"};
    scored.label.towards_deg = {{"waves", 90.0}};
    return scored;
  };
  const Figures figures = FiguresOf({in_waves({85.0, 10.0, false}), in_waves({60.0, 20.0, false}),
                                     in_waves({85.0, 90.0, false})});
  ASSERT_EQ(figures.directions.size(), 1U);  // there is no current whose direction is known
  const DirectionFigures& waves = figures.directions.at("waves");
  EXPECT_EQ(waves.told.hits, 2U);
  EXPECT_EQ(waves.told.all, 3U);
  EXPECT_EQ(waves.held.hits, 1U);
  EXPECT_EQ(waves.held.all, 2U);
  EXPECT_THAT(waves.half_widths_deg, ::testing::ElementsAre(10.0, 20.0));
}

TEST(ParseReport, NamesWhatIsWrong) {
  const auto complaint = [](const char* text) -> std::string {
    try {
      ParseReport(text);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "none";
  };
  EXPECT_EQ(complaint("{"), "this is no JSON");
  EXPECT_EQ(complaint("[]"), "this is no JSON object");
  EXPECT_EQ(complaint("{}"), "there is no verdict");
  EXPECT_EQ(complaint(R"({"verdict": "FINE"})"), "there is no verdict FINE");
  EXPECT_EQ(complaint(R"({"verdict": "EXPLAINED", "causes": 3})"), "causes is no list");
  EXPECT_EQ(complaint(R"({"verdict": "EXPLAINED", "causes": [{"probability": 0.3}]})"),
            "a cause names no effect");
  EXPECT_EQ(
      complaint(R"({"verdict": "EXPLAINED", "causes": [{"effects": ["x"], "probability": 3}]})"),
      "a cause's probability is outside [0, 1]");
  EXPECT_EQ(complaint(R"({"verdict": "EXPLAINED", "causes": [3]})"),
            "there is no object where one should be");
}

TEST(Markdown, HasAColumnAFolderAndARowAnEffect) {
  const std::vector<Scored> cases{Answer("nominal", {}, "NO_MATERIAL_GAP", {}),
                                  Answer("single", {"wind"}, "EXPLAINED", {Named({"wind"}, 0.9)})};
  const std::string text =
      Markdown({{"ours", FiguresOf(cases)}, {"best-bic", FiguresOf(cases)}}, cases.size());
  EXPECT_THAT(text, testing::StartsWith("| 2 cases | ours | best-bic |\n|---|---|---|\n"));
  EXPECT_THAT(text,
              testing::HasSubstr("| single effects: top-1 | 100.0 % (1/1) | 100.0 % (1/1) |"));
  EXPECT_THAT(text, testing::HasSubstr("0.0 % (0/1), at most 95.0 %"));  // 1 - 0.05
  EXPECT_THAT(text, testing::HasSubstr("| both of two effects | – | – |"));
  EXPECT_THAT(text, testing::HasSubstr("| wind | 20.0 | 100.0 % (1/1) |"));
  EXPECT_THAT(text, testing::HasSubstr("| NO_MATERIAL_GAP 1 |"));
}

}  // namespace
}  // namespace blind::score
