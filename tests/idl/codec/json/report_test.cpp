#include "telltale/idl/codec/json/report.hpp"

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/made_up_diagnoses.hpp"

namespace telltale {
namespace {

using testing::HasSubstr;
using testing::Not;

proto::Report MadeUpReport() {
  return ToProto(MadeUpDiagnosis());
}

std::string FieldAtFault(const proto::Report& report) {
  const auto diagnosis = DiagnosisOf(report);
  return diagnosis ? "(none)" : diagnosis.error().field;
}

TEST(ReportJson, PrintedAndReadAgainIsTheSame) {
  for (const Diagnosis& made : {MadeUpDiagnosis(), MadeUpNominalDiagnosis()}) {
    const auto again = ParseReportJson(PrintReportJson(made));
    ASSERT_TRUE(again) << again.error().Message();
    ExpectSame(*again, made);
  }
}

TEST(ReportJson, UsesTheNamesOfTheInterface) {
  const std::string json = PrintReportJson(MadeUpDiagnosis());
  for (const char* text : {"\"verdict\": \"PARTLY_EXPLAINED\"",
                           "\"gap\"",
                           "\"before\"",
                           "\"after\"",
                           "\"noiseFloor\"",
                           "\"closure\"",
                           "\"closureInterval\"",
                           "\"level\"",
                           "\"channels\"",
                           "\"channel\": \"SURGE\"",
                           "\"where\"",
                           "\"propellerRegion\": \"FF\"",
                           "\"propellerRegion\": \"ALL\"",
                           "\"bin\": \"after a step\"",
                           "\"excessShare\"",
                           "\"pValue\"",
                           "\"kind\": \"SLOPE\"",
                           "\"causes\"",
                           "\"probability\"",
                           "\"parameters\"",
                           "\"estimate\"",
                           "\"standardError\"",
                           "\"unit\"",
                           "\"indistinguishable\"",
                           "\"unknown\"",
                           "\"effects\"",
                           "\"testability\": \"NOT_EXCITED\"",
                           "\"detectability\"",
                           "\"presentWeather\"",
                           "\"advice\"",
                           "\"manoeuvre\"",
                           "\"separates\"",
                           "\"durationS\"",
                           "\"expectedNats\""}) {
    EXPECT_THAT(json, HasSubstr(text));
  }
}

TEST(ReportJson, TheGapIsThatOfFiveSeconds) {
  const proto::Report report = MadeUpReport();
  EXPECT_EQ(report.gap().horizon_s(), 5.0);
  EXPECT_EQ(report.horizons_size(), 3);
}

TEST(ReportJson, AClosureThatIsNotDefinedIsAbsent) {
  EXPECT_THAT(PrintReportJson(MadeUpNominalDiagnosis()), Not(HasSubstr("losure")));
}

TEST(ReportJson, EveryNameOfCoreIsThatOfTheFile) {
  Diagnosis made = MadeUpNominalDiagnosis();
  for (const Verdict verdict :
       {Verdict::kNoMaterialGap, Verdict::kExplained, Verdict::kPartlyExplained,
        Verdict::kUnknownCause, Verdict::kInsufficientData}) {
    made.verdict = verdict;
    EXPECT_EQ(proto::DiagnosisVerdict_Name(ToProto(made).verdict()), Name(verdict));
  }
  for (const GapKind kind : {GapKind::kBias, GapKind::kSlope, GapKind::kTiming, GapKind::kNoise}) {
    made.where = {{Equation::kYaw, std::nullopt, "", 0.5, 0.01, kind, 1.0, 1}};
    EXPECT_EQ(proto::GapCell::Kind_Name(ToProto(made).where(0).kind()), Name(kind));
  }
  for (const PropellerRegion region : kPropellerRegions) {
    made.where[0].region = region;
    EXPECT_EQ(proto::GapCell::PropellerRegion_Name(ToProto(made).where(0).propeller_region()),
              Name(region));
  }
  for (const Testability testability :
       {Testability::kTestable, Testability::kMasked, Testability::kNotExcited}) {
    made.effects = {{"wind", testability, 1.0, ""}};
    EXPECT_EQ(proto::EffectTestability::Testability_Name(ToProto(made).effects(0).testability()),
              Name(testability));
  }
}

TEST(ReportJson, PathsAreKeptOfTheWorstWindowsInOrderOfTime) {
  const Diagnosis made = MadeUpDiagnosis();
  const auto worst = WorstWindows(made.pictures);
  ASSERT_EQ(worst.size(), kShownPaths);
  EXPECT_TRUE(std::is_sorted(worst.begin(), worst.end()));
  const auto again = ParseReportJson(PrintReportJson(made));
  ASSERT_TRUE(again) << again.error().Message();
  double least_shown = 1e9;
  double largest_hidden = 0.0;
  for (std::size_t i = 0; i < made.pictures.size(); ++i) {
    const WindowPicture& picture = again->pictures[i];
    const bool shown = std::find(worst.begin(), worst.end(), i) != worst.end();
    EXPECT_EQ(picture.measured.empty(), !shown);
    if (shown) {
      EXPECT_EQ(picture.measured, made.pictures[i].measured);
      EXPECT_EQ(picture.predicted_before, made.pictures[i].predicted_before);
      EXPECT_EQ(picture.predicted_after, made.pictures[i].predicted_after);
      least_shown = std::min(least_shown, picture.before);
    } else {
      largest_hidden = std::max(largest_hidden, picture.before);
    }
  }
  EXPECT_GE(least_shown, largest_hidden);
}

TEST(ReportJson, RefusesWhatNoDiagnosisSays) {
  proto::Report report = MadeUpReport();
  report.set_verdict(proto::UNKNOWN_VERDICT);
  EXPECT_EQ(FieldAtFault(report), "verdict");

  report = MadeUpReport();
  report.clear_horizons();
  EXPECT_EQ(FieldAtFault(report), "horizons");

  report = MadeUpReport();
  report.mutable_causes(1)->set_probability(1.5);
  EXPECT_EQ(FieldAtFault(report), "causes[1].probability");

  report = MadeUpReport();
  report.mutable_causes(0)->mutable_parameters(0)->set_effect("waves");
  EXPECT_EQ(FieldAtFault(report), "causes[0].parameters[0].effect");

  report = MadeUpReport();
  report.mutable_where(0)->set_p_value(std::numeric_limits<double>::quiet_NaN());
  EXPECT_EQ(FieldAtFault(report), "where[0].pValue");

  report = MadeUpReport();
  report.mutable_pictures(0)->add_measured(1.0);
  EXPECT_EQ(FieldAtFault(report), "pictures[0].measured");

  report = MadeUpReport();
  report.mutable_pictures(0)->set_propeller_region(proto::GapCell::ALL);
  EXPECT_EQ(FieldAtFault(report), "pictures[0].propellerRegion");

  report = MadeUpReport();
  report.mutable_horizons(0)->clear_closure_interval();
  EXPECT_EQ(FieldAtFault(report), "horizons[0].closureInterval");

  EXPECT_FALSE(ParseReportJson("{"));
  EXPECT_EQ(ParseReportJson("{\"gap\": {\"later\": 1}}").error().field, "gap.later");
}

}  // namespace
}  // namespace telltale
