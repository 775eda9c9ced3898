#include <filesystem>
#include <regex>
#include <sstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/made_up_diagnoses.hpp"
#include "support/telltale_command.hpp"
#include "support/temporary_folder.hpp"
#include "telltale/client/cli/diagnosis_table.hpp"
#include "telltale/client/cli/table.hpp"
#include "telltale/client/recording/telemetry_log/telemetry_log.hpp"
#include "telltale/core/paper/sample_mission.hpp"
#include "telltale/core/paper/yellowfish.hpp"
#include "telltale/core/simulation/manoeuvres.hpp"
#include "telltale/core/simulation/sensors.hpp"
#include "telltale/idl/codec/json/report.hpp"
#include "telltale/idl/codec/vehicle_file.hpp"

namespace telltale {
namespace {

using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

// ---- the table ------------------------------------------------------------------------------

TEST(DiagnosisTable, SaysTheSentenceFirstAndThenEveryPart) {
  const std::string rendered = DiagnosisTable(MadeUpDiagnosis());
  EXPECT_THAT(rendered, StartsWith("Port thruster 22 ± 3 % weaker than the model"));
  std::istringstream lines(rendered);
  for (std::string line; std::getline(lines, line);) EXPECT_LE(DisplayWidth(line), 80u) << line;
  const std::string table = std::regex_replace(rendered, std::regex("\\s+"), " ");
  for (const char* part :
       {"Partly explained",
        "400 s recorded",
        "205 s after the start (95 %: 195 to 220 s)",
        "3 reference recordings",
        "81 % [74, 87]",
        "-25 % [-50, 12]",
        "heading, FF, 0.5 to 1.0 m/s",
        "thruster_imbalance + thruster_lag",
        "port thruster 22 % weaker (75 % of what these explain)",
        "0.220 ± 0.030",
        "0.150 ± 0.035 s",
        "cannot separate it from thruster_delay",
        "unknown: probability 6 %",
        "Its odds, in nats: +0.4 by what effects still predict of the errors that are left, "
        "+0.1 to begin with, -0.5 by the errors of the median window, "
        "-2.2 by the share of the excess that is left.",
        "commands -0.06 ± 0.24 s 0.75 s",
        "positions 0.38 ± 0.12 s beyond range",
        "masked by YAW uv",
        "not excited",
        "loss_port 0.047, loss_starboard beyond range",
        "monday 4.50 1.75 1.50 Cause unknown: wind + current (62 %)",
        "friday 0.00 0.00 – Not diagnosed",
        "Missing is a surge force that is -4.0 ± 0.8 N on headings of 0 to 36 deg",
        "for a mass of 15.0 kg",
        "0 to 36 -4.00 ± 0.75 0.50 ± 0.25 0.12 ± 0.06",
        "fast random steps for 120 s",
        "-> full ahead for 20 s, then nothing",
        "- the wind was not measured"}) {
    EXPECT_THAT(table, HasSubstr(part));
  }
}

TEST(DiagnosisTable, SaysInWordsWhereThereIsNothing) {
  const std::string table = DiagnosisTable(MadeUpNominalDiagnosis());
  for (const char* part : {"no operating condition stands out", "nothing to explain"}) {
    EXPECT_THAT(table, HasSubstr(part));
  }
  for (const char* part :
       {"Notes", "Recommended manoeuvres", "of typical size", "free-run RMSE", "Missing is"}) {
    EXPECT_THAT(table, Not(HasSubstr(part)));
  }
}

TEST(DiagnosisTable, ShowsADozenOperatingConditionsAndCountsTheRest) {
  Diagnosis made = MadeUpDiagnosis();
  made.where.resize(15, made.where[0]);
  EXPECT_THAT(DiagnosisTable(made), HasSubstr("3 more operating conditions stand out"));
  made.where.resize(12);
  EXPECT_THAT(DiagnosisTable(made), Not(HasSubstr("more operating condition")));
}

// ---- the command ----------------------------------------------------------------------------

/// A folder with the vehicle file, a log of the Yellowfish twin and a model of it.
class DiagnoseTest : public testing::Test {
 protected:
  DiagnoseTest() {
    folder.Write("boat.textproto", PrintVehicle(YellowfishVehicle()));
    WriteLog("log", kSampleMissionDurationS);
    const CommandOutcome made =
        Telltale({"identify", "--log", Path("log"), "--vehicle", Path("boat.textproto"),
                  "--estimator", "one-step", "--bootstrap", "0", "--out", Path("model.json")});
    EXPECT_EQ(made.exit_code, kExitSuccess) << made.err;
  }

  std::string Path(const std::string& name) const { return (folder.Path() / name).string(); }

  void WriteLog(const std::string& name, double duration_s, std::uint64_t seed = 1) const {
    const auto track = Simulate(YellowfishTwin(), {}, SampleMission(seed), duration_s, 0.02);
    SensorOptions sensors;
    sensors.seed = seed;
    WriteTelemetryLog(Path(name), Measure(track, YellowfishVehicle(), sensors));
  }

  CommandOutcome Diagnose(const std::string& log, const std::string& vehicle,
                          std::vector<std::string> more = {}) const {
    std::vector<std::string> arguments = {"diagnose",    "--log",   Path(log),         "--vehicle",
                                          Path(vehicle), "--model", Path("model.json")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return Telltale(arguments);
  }

  TemporaryFolder folder;
};

TEST_F(DiagnoseTest, WritesTheReportAndThePageAndPrintsTheSentenceFirst) {
  const CommandOutcome outcome =
      Diagnose("log", "boat.textproto",
               {"--out", Path("report.json"), "--html", Path("report.html"), "--seed", "7"});
  ASSERT_EQ(outcome.exit_code, kExitSuccess) << outcome.err;
  const auto report = ParseReportJson(TextOfFile(Path("report.json")));
  ASSERT_TRUE(report) << report.error().Message();
  EXPECT_EQ(report->vehicle_id, YellowfishVehicle().vehicle_id);
  EXPECT_EQ(report->seed, 7u);
  EXPECT_NEAR(report->end_s - report->start_s, kSampleMissionDurationS, 10.0);
  EXPECT_THAT(outcome.out, StartsWith(report->sentence.substr(0, 40)));
  EXPECT_THAT(TextOfFile(Path("report.html")), HasSubstr("<h1 id=\"headline\">"));
}

TEST_F(DiagnoseTest, WrongCommandLinesAreUsageErrors) {
  const std::string log = Path("log");
  const std::string boat = Path("boat.textproto");
  const std::string model = Path("model.json");
  for (const std::vector<std::string>& arguments : std::vector<std::vector<std::string>>{
           {"diagnose"},
           {"diagnose", "--log", log, "--vehicle", boat},
           {"diagnose", "--vehicle", boat, "--model", model},
           {"diagnose", "--log", log, "--model", model},
           {"diagnose", "--log", Path("nowhere"), "--vehicle", boat, "--model", model},
           {"diagnose", "--log", log, "--vehicle", boat, "--model", Path("nowhere")},
           {"diagnose", "--log", log, "--vehicle", boat, "--model", model, "--reference-log",
            Path("nowhere")},
           {"diagnose", "--log", log, "--vehicle", boat, "--model", model, "--without",
            "kraken"}}) {
    const CommandOutcome outcome = Telltale(arguments);
    EXPECT_EQ(outcome.exit_code, kExitUsage) << testing::PrintToString(arguments) << outcome.err;
  }
  EXPECT_THAT(Diagnose("log", "boat.textproto", {"--without", "kraken"}).err, HasSubstr("wind"));
}

TEST_F(DiagnoseTest, AModelOfAnotherBoatIsRefused) {
  Vehicle other = YellowfishVehicle();
  other.vehicle_id = "bluefish";
  folder.Write("other.textproto", PrintVehicle(other));
  const CommandOutcome outcome = Diagnose("log", "other.textproto");
  EXPECT_EQ(outcome.exit_code, kExitRefused);
  EXPECT_THAT(outcome.err, HasSubstr("bluefish"));
}

TEST_F(DiagnoseTest, EmptyAndShortLogsAreRefused) {
  WriteLog("short", 45.0);
  WriteTelemetryLog(Path("empty"), {});
  EXPECT_EQ(Diagnose("short", "boat.textproto").exit_code, kExitRefused);
  const CommandOutcome empty = Diagnose("empty", "boat.textproto");
  EXPECT_EQ(empty.exit_code, kExitRefused);
  EXPECT_THAT(empty.err, HasSubstr("empty"));
}

TEST_F(DiagnoseTest, AReferenceThatCannotBeUsedIsNamed) {
  WriteTelemetryLog(Path("blank"), {});
  const CommandOutcome outcome =
      Diagnose("log", "boat.textproto", {"--reference-log", Path("blank")});
  EXPECT_EQ(outcome.exit_code, kExitRefused);
  EXPECT_THAT(outcome.err, HasSubstr("blank"));
}

TEST_F(DiagnoseTest, ARecordingIsNotItsOwnReference) {
  const CommandOutcome outcome =
      Diagnose("log", "boat.textproto", {"--reference-log", Path("log")});
  EXPECT_EQ(outcome.exit_code, kExitRefused);
  EXPECT_THAT(outcome.err, HasSubstr("both the recording to diagnose and a reference"));
}

TEST_F(DiagnoseTest, AReferenceThatMadeTheModelIsRefused) {
  WriteLog("today", 200.0, 2);  // another mission: the same one would be the same recording
  const CommandOutcome outcome =
      Diagnose("today", "boat.textproto", {"--reference-log", Path("log")});
  EXPECT_EQ(outcome.exit_code, kExitRefused);
  EXPECT_THAT(outcome.err, HasSubstr("made the model (as log)"));
}

TEST_F(DiagnoseTest, AReferenceCountsOnce) {
  WriteLog("monday", 150.0, 2);
  const CommandOutcome outcome =
      Diagnose("log", "boat.textproto",
               {"--reference-log", Path("monday"), "--reference-log", Path("monday") + "/"});
  EXPECT_EQ(outcome.exit_code, kExitRefused);
  EXPECT_THAT(outcome.err, HasSubstr("holds the same recording as"));
}

TEST_F(DiagnoseTest, SaysWhatEachReferenceDoesAndThatTheModelKnowsTheRecording) {
  WriteLog("monday", 150.0, 2);
  WriteLog("tuesday", 150.0, 3);
  const CommandOutcome outcome = Diagnose("log", "boat.textproto",
                                          {"--reference-log", Path("monday"), "--reference-log",
                                           Path("tuesday"), "--out", Path("report.json")});
  ASSERT_EQ(outcome.exit_code, kExitSuccess) << outcome.err;
  const auto report = ParseReportJson(TextOfFile(Path("report.json")));
  ASSERT_TRUE(report) << report.error().Message();
  ASSERT_EQ(report->reference_influence.size(), 2u);
  EXPECT_EQ(report->reference_influence[0].reference, "monday");
  EXPECT_EQ(report->reference_influence[1].reference, "tuesday");
  EXPECT_NE(report->reference_influence[0].verdict, Verdict::kUnknown);
  EXPECT_THAT(report->notes, testing::Contains(HasSubstr("The recording made the model (as log)")));
}

TEST_F(DiagnoseTest, AModelFileThatIsNoneFailsNamingTheFault) {
  folder.Write("model.json", "{\"vehicleId\": 3}");
  const CommandOutcome outcome = Diagnose("log", "boat.textproto");
  EXPECT_EQ(outcome.exit_code, kExitFailure);
  EXPECT_THAT(outcome.err, HasSubstr("vehicleId"));
}

}  // namespace
}  // namespace telltale
