#include "telltale/client/cli/quality_table.hpp"

#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "telltale/client/cli/duration_text.hpp"
#include "telltale/client/cli/table.hpp"
#include "telltale/idl/codec/json/json_message.hpp"
#include "telltale/idl/codec/json/quality.hpp"

namespace telltale {
namespace {

using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Le;
using ::testing::Not;

Quality Boat(const std::string& id, QualityVerdict verdict, double error) {
  Quality quality;
  quality.vehicle_id = id;
  quality.verdict = verdict;
  quality.prediction_error = error;
  quality.model_revision = 12;
  quality.model_age_s = 5.0e6;
  quality.gnss_rate_hz = quality.heading_rate_hz = quality.thrusters_rate_hz = 50.04;
  quality.rejected = {{"heading", "OUT_OF_ORDER", 123456}};
  if (verdict != QualityVerdict::kOk) {
    quality.reasons = {{"DRIFT", verdict, "the model of " + id + " no longer matches the boat"}};
  }
  return quality;
}

std::map<std::string, Quality> FleetOfFour() {
  std::map<std::string, Quality> fleet;
  for (const Quality& quality :
       {Boat("a", QualityVerdict::kOk, 1.0), Boat("b", QualityVerdict::kWarn, 2.5),
        Boat("c", QualityVerdict::kStale, 0.5),
        Boat("d-with-an-id-that-is-rather-long", QualityVerdict::kError, 3.5)}) {
    fleet[quality.vehicle_id] = quality;
  }
  fleet[std::string(kUnattributed)].vehicle_id = kUnattributed;
  return fleet;
}

std::string Ids(const QualityView& view) {
  std::string ids;
  for (const Quality& quality : Selected(FleetOfFour(), view)) ids += quality.vehicle_id[0];
  return ids;
}

std::vector<std::size_t> LineWidths(const std::string& text) {
  std::vector<std::size_t> widths;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) widths.push_back(DisplayWidth(line));
  return widths;
}

TEST(QualityTable, SortsAndFilters) {
  EXPECT_EQ(Ids({}), "dcba");
  EXPECT_EQ(Ids({QualityOrder::kId, {}, ""}), "abcd");
  EXPECT_EQ(Ids({QualityOrder::kError, {}, ""}), "dbac");
  EXPECT_EQ(Ids({QualityOrder::kId, {QualityVerdict::kWarn, QualityVerdict::kOk}, ""}), "ab");
  EXPECT_EQ(Ids({QualityOrder::kId, {}, "long"}), "d");
}

TEST(QualityTable, FitsATerminal) {
  EXPECT_THAT(LineWidths(QualityTable(FleetOfFour(), {})), Each(Le(kTerminalColumns)));
  Quality quality = Boat("boat", QualityVerdict::kError, 3.0);
  quality.indicative = {{Equation::kSurge, "f:d", "W11bf", 0.25, 0.0125, "m/s^2"}};
  quality.last_refusal =
      Refusal{"surge", std::string(30, 'x') + " is not excited", "drive a zigzag"};
  quality.diagnosis_verdict = "EXPLAINED";
  quality.diagnosis_sentence = "The starboard thruster gives 25 % less thrust than the model has.";
  quality.model_verdict = {PromotionVerdict::kWarn, "simulated over its whole data it diverges"};
  quality.delays = {{Channel::kThrusters, -0.25, -0.5, 0.25}};
  EXPECT_THAT(QualityDetail(quality, 1000.0),
              HasSubstr("model verdict WARN: simulated over its whole data it diverges"));
  EXPECT_THAT(QualityDetail(quality, 1000.0),
              HasSubstr("thrusters -0.25 [-0.50, 0.25] s behind the headings"));
  quality.drift_untested =
      "port thruster, starboard thruster, drag, compass: commands and heading vary too little";
  EXPECT_THAT(QualityDetail(quality, 1000.0), HasSubstr("no drift test port thruster, starboard"));
  EXPECT_THAT(LineWidths(QualityDetail(quality, 1000.0)), Each(Le(kTerminalColumns)));
}

TEST(QualityTable, CountsVerdictsAndNamesReasons) {
  const std::string text = QualityTable(FleetOfFour(), {});
  EXPECT_THAT(text, HasSubstr("4 boats: 1 ERROR, 1 STALE, 1 WARN, 1 OK"));
  EXPECT_THAT(text, HasSubstr("WARN the model of b no longer matches the boat"));
  EXPECT_THAT(text, Not(HasSubstr("the model of a")));
}

TEST(QualityTable, GivesTheAdviceInFull) {
  std::map<std::string, Quality> fleet = FleetOfFour();
  fleet["b"].proposal = "it is late; refresh it";
  EXPECT_THAT(QualityTable(fleet, {}), HasSubstr("\n  it is late; refresh it\n"));
  EXPECT_THAT(QualityDetail(fleet["b"], 1000.0),
              HasSubstr("advice        it is late; refresh it\n"));
}

TEST(QualityTable, NamesNoTimeOfASampleThatNeverCame) {
  Quality quality = Boat("boat", QualityVerdict::kStale, 0.0);
  quality.silent_s = 4.0;
  EXPECT_THAT(QualityDetail(quality, 1000.0), HasSubstr("newest sample 4 s ago"));
  quality.rejected.clear();
  EXPECT_THAT(QualityDetail(quality, 1000.0), HasSubstr("newest sample none"));
}

TEST(QualityJson, IsOneLineThatReadsBack) {
  Quality quality = Boat("boat", QualityVerdict::kWarn, 2.0);
  quality.drift_evidence = "drag 40 % more";
  quality.position = QualityPosition{59.5, 10.25, 90.0};
  const std::string line = PrintQualityLine(quality, 1234.5);
  EXPECT_THAT(line, Not(HasSubstr("\n")));
  proto::Quality read;
  ASSERT_FALSE(ParseJsonMessage(line, "line", read));
  EXPECT_EQ(read.vehicle_id(), "boat");
  EXPECT_EQ(read.verdict(), proto::Quality::WARN);
  EXPECT_EQ(read.time_unix_s(), 1234.5);
  EXPECT_EQ(read.reasons(0).code(), "DRIFT");
  EXPECT_EQ(read.model().revision(), 12u);
  EXPECT_EQ(read.model().drift_evidence(), "drag 40 % more");
  EXPECT_EQ(read.position().heading_deg(), 90.0);
  EXPECT_FALSE(read.has_last_refusal());
}

TEST(QualityJson, NamesVerdictsAsTheBusDoes) {
  for (const QualityVerdict verdict : kQualityVerdicts) {
    EXPECT_EQ(proto::Quality::Verdict_Name(static_cast<int>(verdict)), Name(verdict));
  }
}

TEST(DurationText, ChoosesTheUnit) {
  EXPECT_EQ(DurationText(-1.0), "0 s");
  EXPECT_EQ(DurationText(119.0), "119 s");
  EXPECT_EQ(DurationText(120.0), "2 min");
  EXPECT_EQ(DurationText(7200.0), "2.0 h");
  EXPECT_EQ(DurationText(172800.0), "2 d");
}

}  // namespace
}  // namespace telltale
