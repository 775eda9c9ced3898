#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/made_up_identifications.hpp"
#include "support/telltale_command.hpp"
#include "support/temporary_folder.hpp"
#include "telltale/client/recording/csv/numeric_csv.hpp"
#include "telltale/client/recording/load_recording.hpp"
#include "telltale/client/recording/telemetry_log/telemetry_log.hpp"
#include "telltale/core/data/preparation.hpp"
#include "telltale/core/identification/input_gain.hpp"
#include "telltale/core/paper/sample_mission.hpp"
#include "telltale/core/paper/yellowfish.hpp"
#include "telltale/core/simulation/manoeuvres.hpp"
#include "telltale/core/simulation/sensors.hpp"
#include "telltale/idl/codec/json/json_message.hpp"
#include "telltale/idl/codec/json/metrics.hpp"
#include "telltale/idl/codec/json/model.hpp"
#include "telltale/idl/codec/vehicle_file.hpp"
#include "telltale/idl/proto/study.pb.h"

namespace telltale {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

/// A folder with the vehicle file and a ten-minute log of the Yellowfish twin.
class CommandTest : public testing::Test {
 protected:
  CommandTest() {
    folder.Write("boat.textproto", PrintVehicle(YellowfishVehicle()));
    WriteTelemetryLog(Path("log"), Measured(0.0));
  }

  static Recording Measured(double start_s) {
    auto commands = SampleMission(1);
    for (TimedCommand& command : commands) command.time_s += start_s;
    const double end_s = start_s + kSampleMissionDurationS;
    const auto track = Simulate(YellowfishTwin(), {}, commands, end_s, 0.02);
    return Measure(track, YellowfishVehicle(), {});
  }

  std::string Path(const std::string& name) const { return (folder.Path() / name).string(); }

  /// Few replicates unless `more` says how many: these tests are not about the bounds.
  CommandOutcome Identify(std::vector<std::string> more) const {
    if (std::find(more.begin(), more.end(), "--bootstrap") == more.end()) {
      more.insert(more.end(), {"--bootstrap", "100"});
    }
    std::vector<std::string> arguments = {"identify", "--log", Path("log"), "--vehicle",
                                          Path("boat.textproto")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return Telltale(arguments);
  }

  CommandOutcome Validate(std::vector<std::string> more) const {
    std::vector<std::string> arguments = {
        "validate", "--log",           Path("log"), "--vehicle", Path("boat.textproto"),
        "--model",  Path("model.json")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return Telltale(arguments);
  }

  CommandOutcome Simulated(std::vector<std::string> more) const {
    std::vector<std::string> arguments = {"simulate",
                                          "--model",
                                          Path("model.json"),
                                          "--vehicle",
                                          Path("boat.textproto"),
                                          "--commands",
                                          Path("log/thrusters.csv")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return Telltale(arguments);
  }

  void MakeModel() const {
    ASSERT_EQ(Identify({"--out", Path("model.json")}).exit_code, kExitSuccess);
  }

  TemporaryFolder folder;
};

// ---- usage -----------------------------------------------------------------------------------

TEST(LiveCommand, TakesNoTimeoutThatIsNoNumber) {
  for (const char* wrong : {"nan", "-1", "inf"}) {
    const auto run = Telltale({"watch", "--all", "--count", "1", "--timeout", wrong});
    EXPECT_EQ(run.exit_code, kExitUsage) << wrong;
    EXPECT_THAT(run.err, HasSubstr("--timeout"));
  }
}

TEST_F(CommandTest, HelpIsNoError) {
  for (const char* subcommand : {"identify", "validate", "simulate", "export"}) {
    const CommandOutcome outcome = Telltale({subcommand, "--help"});
    EXPECT_EQ(outcome.exit_code, kExitSuccess);
    EXPECT_THAT(outcome.out, AllOf(HasSubstr("--vehicle FILE"), HasSubstr("Example: telltale")));
    EXPECT_THAT(outcome.err, IsEmpty());
  }
  EXPECT_THAT(Telltale({"--help"}).out, HasSubstr("Exit codes"));
}

TEST_F(CommandTest, WrongCommandLinesAreUsageErrors) {
  const std::string log = Path("log");
  const std::string boat = Path("boat.textproto");
  for (const std::vector<std::string>& arguments : std::vector<std::vector<std::string>>{
           {},
           {"identfy"},
           {"identify"},
           {"identify", "--log", log},
           {"identify", "--vehicle", boat},
           {"identify", "--log", Path("nowhere"), "--vehicle", boat},
           {"identify", "--log", log, "--vehicle", Path("nowhere")},
           {"identify", "--log", log, "--vehicle", boat, "--colour", "red"},
           {"validate", "--log", log, "--vehicle", boat},
           {"validate", "--log", log, "--vehicle", boat, "--model", Path("nowhere")},
           {"simulate", "--out", Path("s")}}) {
    const CommandOutcome outcome = Telltale(arguments);
    EXPECT_EQ(outcome.exit_code, kExitUsage) << testing::PrintToString(arguments);
    EXPECT_THAT(outcome.err, Not(IsEmpty()));
    EXPECT_THAT(outcome.out, IsEmpty());
  }
  EXPECT_THAT(Telltale({"identfy"}).err, HasSubstr("identfy: no such command"));
}

TEST_F(CommandTest, OptionsOutOfRangeAreUsageErrorsThatNameTheRange) {
  const auto expect = [this](const std::vector<std::string>& more, const char* named) {
    const CommandOutcome outcome = Identify(more);
    EXPECT_EQ(outcome.exit_code, kExitUsage) << testing::PrintToString(more);
    EXPECT_THAT(outcome.err, HasSubstr(named));
  };
  expect({"--bootstrap", "50"}, "100000");
  expect({"--bootstrap", "-1"}, "--bootstrap");
  expect({"--bootstrap", "many"}, "--bootstrap");
  expect({"--bootstrap-kind", "rows"}, "moving-blocks");
  expect({"--interval", "bayes"}, "studentized");
  expect({"--level", "0.2"}, "[0.5, 0.999]");
  expect({"--level", "nan"}, "[0.5, 0.999]");
  expect({"--threads", "0"}, "[1, 256]");
  expect({"--sampling-period", "5"}, "--sampling-period = 5");
  expect({"--check-coverage", "3"},
         "--check-coverage = 3 must be within [10, 1000]; set --check-coverage to");
  for (const char* counts :
       {"--replicates", "--bootstrap", "--check-coverage", "--seed", "--threads"}) {
    expect({counts, "-3"}, ": -3 must be a whole number, 0 or more");
    expect({counts, "2.5"}, ": 2.5 must be a whole number, 0 or more");
  }
  expect({"--preset", "best"}, "robust");
  expect({"--parameterization", "cubic"}, "propeller");
  expect({"--seed", "-3"}, "--seed");
  expect({"--structure", "cubic"}, "dynamic");
  expect({"--dead-zone", "0.05"}, "two limits");
  expect({"--dead-zone", "0.05,wide"}, "wide");
  expect({"--dead-zone", "0.31,0"}, "[0, 0.3]");
  expect({"--dead-zone", "0.1,0.1"}, "[-0.3, 0]");
  expect({"--dead-zone", "nan,0"}, "[0, 0.3]");
}

TEST_F(CommandTest, OptionsOfOneEstimatorDoNotGoWithTheOther) {
  EXPECT_THAT(Identify({"--estimator", "weak-iv"}).err,
              HasSubstr("belong to --estimator one-step"));
  EXPECT_THAT(Identify({"--estimator", "output-error"}).err,
              HasSubstr("belong to --estimator one-step"));
  EXPECT_THAT(Identify({"--replicates", "20"}).err, HasSubstr("belongs to --estimator weak-iv"));
  EXPECT_THAT(Telltale({"identify", "--log", Path("log"), "--vehicle", Path("boat.textproto"),
                        "--estimator", "output-error", "--replicates", "20"})
                  .err,
              HasSubstr("belongs to --estimator weak-iv"));
}

TEST_F(CommandTest, OptionsOfThePaperDoNotGoWithThePhysicalForm) {
  const std::vector<std::vector<std::string>> others = {
      {"--parameterization", "paper"}, {"--dead-zone", "identify"}, {"--estimator", "weak-iv"},
      {"--replicates", "20"},          {"--bootstrap", "100"},      {"--recording-bias", "shared"},
      {"--check-coverage", "20"},      {"--preset", "paper"}};
  for (const std::vector<std::string>& other : others) {
    std::vector<std::string> arguments = {
        "identify",    "--log", Path("log"), "--vehicle", Path("boat.textproto"),
        "--structure", "fossen"};
    arguments.insert(arguments.end(), other.begin(), other.end());
    const CommandOutcome outcome = Telltale(arguments);
    EXPECT_EQ(outcome.exit_code, kExitUsage) << other.front();
    EXPECT_THAT(outcome.err, AllOf(HasSubstr(other.front()), HasSubstr("static and dynamic")));
  }
}

// ---- identify --------------------------------------------------------------------------------

/// The twin's sensors are all that keeps it and its model apart.
TEST_F(CommandTest, IdentifySaysWhichEstimatorTheDataChoseAndWhy) {
  const CommandOutcome outcome =
      Telltale({"identify", "--log", Path("log"), "--vehicle", Path("boat.textproto"),
                "--structure", "static", "--out", Path("model.json")});
  EXPECT_EQ(outcome.exit_code, kExitSuccess) << outcome.err;
  EXPECT_THAT(outcome.out, AllOf(HasSubstr(", estimated by output error, h ="),
                                 HasSubstr("Estimator chosen: output error, since")));
  const auto model = ParseModelJson(TextOfFile(Path("model.json")));
  ASSERT_TRUE(model) << model.error().Message();
  EXPECT_EQ(model->estimator, Estimator::kOutputError);
  EXPECT_THAT(model->provenance.estimator_choice, HasSubstr("misspecification ratio"));
  EXPECT_GT(model->provenance.misspecification, 0.5);
}

/// The twin's coefficients lie outside the physical form.
TEST_F(CommandTest, IdentifySaysWhichStructureTheDataChoseAndWhy) {
  const CommandOutcome outcome =
      Telltale({"identify", "--log", Path("log"), "--vehicle", Path("boat.textproto"),
                "--structure", "auto", "--out", Path("model.json")});
  EXPECT_EQ(outcome.exit_code, kExitSuccess) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("Structure chosen: free coefficients, since"));
  const auto model = ParseModelJson(TextOfFile(Path("model.json")));
  ASSERT_TRUE(model) << model.error().Message();
  EXPECT_EQ(model->structure, Structure::kStaticQuadratic);
  EXPECT_THAT(model->provenance.structure_choice, HasSubstr("of constant velocity"));
}

TEST_F(CommandTest, AnOptionThatOnlyFreeCoefficientsHaveNamesThem) {
  for (const std::vector<std::string>& structure :
       std::vector<std::vector<std::string>>{{}, {"--structure", "auto"}}) {
    const CommandOutcome outcome = Identify(structure);
    EXPECT_EQ(outcome.exit_code, kExitSuccess) << outcome.err;
    EXPECT_THAT(outcome.out, AllOf(HasSubstr("W11af"), Not(HasSubstr("Structure chosen"))));
  }
}

TEST_F(CommandTest, IdentifyUsesTheEstimatorThatIsNamed) {
  const CommandOutcome outcome =
      Telltale({"identify", "--log", Path("log"), "--vehicle", Path("boat.textproto"),
                "--estimator", "output-error", "--json"});
  EXPECT_EQ(outcome.exit_code, kExitSuccess) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("\"OUTPUT_ERROR\""));
  EXPECT_THAT(outcome.out, Not(HasSubstr("since no disturbance")));
}

TEST_F(CommandTest, IdentifyPrintsATableAndWritesTheModel) {
  const CommandOutcome outcome = Identify({"--out", Path("model.json")});
  EXPECT_EQ(outcome.exit_code, kExitSuccess) << outcome.err;
  EXPECT_THAT(outcome.err, IsEmpty());
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("yellowfish"), HasSubstr("SURGE"), HasSubstr("W11af"),
                                 HasSubstr("95 % bounds"), HasSubstr("Bounds rest on")));
  const auto model = ParseModelJson(TextOfFile(Path("model.json")));
  ASSERT_TRUE(model) << model.error().Message();
  EXPECT_EQ(model->vehicle_id, "yellowfish");
  EXPECT_TRUE(ModelOf(*model));
}

TEST_F(CommandTest, IdentifyPrintsTheSameJsonItWrites) {
  const CommandOutcome outcome = Identify({"--json", "--out", Path("model.json")});
  EXPECT_EQ(outcome.exit_code, kExitSuccess) << outcome.err;
  EXPECT_EQ(outcome.out, TextOfFile(Path("model.json")));
}

TEST_F(CommandTest, ThreadsDoNotChangeTheModelAndTheSeedDoes) {
  const std::string one = Identify({"--json", "--threads", "1"}).out;
  EXPECT_EQ(Identify({"--json", "--threads", "2"}).out, one);
  EXPECT_NE(Identify({"--json", "--seed", "2"}).out, one);
}

TEST_F(CommandTest, IdentifyTakesThePapersOptions) {
  const CommandOutcome outcome = Identify(
      {"--preset", "paper", "--parameterization", "paper", "--level", "0.9", "--discrete"});
  EXPECT_EQ(outcome.exit_code, kExitSuccess) << outcome.err;
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("mean^2+diff^2/4"), HasSubstr("90 % bounds"),
                                 HasSubstr("Coefficients times h = 0.2 s")));
}

TEST_F(CommandTest, ADynamicModelIsIdentifiedValidatedAndSimulated) {
  const CommandOutcome outcome = Identify({"--structure", "dynamic", "--dead-zone", "0.05,-0.06",
                                           "--discrete", "--out", Path("model.json")});
  EXPECT_EQ(outcome.exit_code, kExitSuccess) << outcome.err;
  EXPECT_THAT(outcome.out,
              AllOf(HasSubstr("thruster time constant"), HasSubstr("dead zone: no thrust from"),
                    HasSubstr("alpha = exp(-h / tau)")));
  const auto model = ParseModelJson(TextOfFile(Path("model.json")));
  ASSERT_TRUE(model) << model.error().Message();
  EXPECT_EQ(model->structure, Structure::kFirstOrderDynamic);
  EXPECT_EQ(model->dead_zone, (DeadZone{0.05, -0.06}));
  EXPECT_EQ(Validate({}).exit_code, kExitSuccess);
  EXPECT_EQ(Simulated({"--out", Path("simulated")}).exit_code, kExitSuccess);
  EXPECT_EQ(Simulated({"--out", Path("finer"), "--step", "0.02"}).exit_code, kExitSuccess);
}

TEST_F(CommandTest, AModelOfOneSecondIsScoredOverTheHorizonsThatItHas) {
  ASSERT_EQ(Identify({"--sampling-period", "1", "--out", Path("model.json")}).exit_code,
            kExitSuccess);
  const CommandOutcome score = Validate({"--json"});
  ASSERT_EQ(score.exit_code, kExitSuccess) << score.err;
  const auto metrics = ParseMetricsJson(score.out);
  ASSERT_TRUE(metrics) << metrics.error().Message();
  std::vector<double> horizons_s;
  for (const FreeRunScores& scores : metrics->free_run) horizons_s.push_back(scores.horizon_s);
  EXPECT_THAT(horizons_s, ::testing::ElementsAre(5.0, 10.0));
  const CommandOutcome asked = Validate({"--horizon", "1"});
  EXPECT_EQ(asked.exit_code, kExitUsage);
  EXPECT_THAT(asked.err, HasSubstr("[2, 600] s"));
}

/// A boat whose propellers always turn alike shows reverse thrust in RR alone.
TEST_F(CommandTest, TheDefaultIsThePhysicalFormWhichIsValidatedAndCompared) {
  const CommandOutcome outcome = Telltale({"identify", "--log", Path("log"), "--vehicle",
                                           Path("boat.textproto"), "--out", Path("model.json")});
  EXPECT_EQ(outcome.exit_code, kExitSuccess) << outcome.err;
  EXPECT_THAT(outcome.out,
              AllOf(HasSubstr("Parameters of the physical form"), HasSubstr("delay_commands"),
                    HasSubstr("prediction-error"), HasSubstr("forward thrust   50 % command")));
  const auto model = ParseModelJson(TextOfFile(Path("model.json")));
  ASSERT_TRUE(model) << model.error().Message();
  ASSERT_TRUE(model->physical);
  EXPECT_EQ(model->physical->parameters.size(), kFossenParameters);
  const CommandOutcome score =
      Telltale({"validate", "--log", Path("log"), "--vehicle", Path("boat.textproto"), "--model",
                Path("model.json"), "--json"});
  EXPECT_EQ(score.exit_code, kExitSuccess) << score.err;
  const auto metrics = ParseMetricsJson(score.out);
  ASSERT_TRUE(metrics) << metrics.error().Message();
  // The twin's free coefficients lie outside the form, which still has to say more than that
  // nothing changes.
  for (const FreeRunScore& velocity : metrics->free_run.back().velocity) {
    EXPECT_LT(velocity.rmse, velocity.constant_velocity_rmse);
  }
  const CommandOutcome change =
      Telltale({"compare", "--model", Path("model.json"), "--model", Path("model.json"), "--json"});
  EXPECT_EQ(change.exit_code, kExitSuccess) << change.err;
  EXPECT_THAT(change.out,
              AllOf(HasSubstr("\"ALIKE\""), HasSubstr("\"Xuu\""), Not(HasSubstr("delay"))));
}

TEST_F(CommandTest, ReverseRowsAreTakenOnRequest) {
  auto commands = SampleMission(1);
  for (TimedCommand& command : commands) command.delta.starboard = command.delta.port;
  const auto track = Simulate(YellowfishTwin(), {}, commands, kSampleMissionDurationS, 0.02);
  WriteTelemetryLog(Path("log"), Measure(track, YellowfishVehicle(), {}));
  const auto surge_reverse = [this](std::vector<std::string> more) {
    more.insert(more.end(), {"--bootstrap", "0", "--json"});
    const auto model = ParseModelJson(Identify(more).out);
    EXPECT_TRUE(model) << model.error().Message();
    return model->coefficients[8];
  };
  EXPECT_EQ(surge_reverse({}).regressor, "r:d");
  // Smoothed commands pass through idle, where a trace of reverse is left.
  EXPECT_LT(surge_reverse({"--include-rr"}).standard_error, 0.5 * surge_reverse({}).standard_error);
}

TEST_F(CommandTest, StudyTakesReverseRowsOnRequestButNeverInThePapersSurge) {
  const auto study = [this](std::vector<std::string> more) {
    std::vector<std::string> arguments = {
        "study",        "--log", Path("log"), "--vehicle", Path("boat.textproto"),
        "--partitions", "1",     "--json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    proto::Study message;
    const auto fault = ParseJsonMessage(Telltale(arguments).out, "study", message);
    EXPECT_FALSE(fault) << fault->Message();
    return message.static_table();
  };
  const proto::CoefficientTable without = study({});
  const proto::CoefficientTable with = study({"--include-rr"});
  ASSERT_GT(without.surge_size(), 0);
  EXPECT_EQ(with.surge(0), without.surge(0));
  EXPECT_NE(with.sway(0), without.sway(0));
}

// The sample mission hardly passes neutral, so all that is sure is that both limits are settled or
// refused.
TEST_F(CommandTest, IdentifySeeksTheDeadZone) {
  const CommandOutcome outcome = Identify({"--dead-zone", "identify", "--json"});
  EXPECT_EQ(outcome.exit_code, kExitSuccess) << outcome.err;
  const auto model = ParseModelJson(outcome.out);
  ASSERT_TRUE(model) << model.error().Message();
  EXPECT_THAT(model->provenance.bounds_basis, HasSubstr("limits of the dead zone"));
}

TEST_F(CommandTest, SeveralLogsAreOneAfterTheOther) {
  WriteTelemetryLog(Path("second"), Measured(7.0));
  const CommandOutcome outcome = Identify({"--log", Path("second"), "--json"});
  EXPECT_EQ(outcome.exit_code, kExitSuccess) << outcome.err;
  const auto model = ParseModelJson(outcome.out);
  ASSERT_TRUE(model) << model.error().Message();
  EXPECT_GT(model->window.end_s - model->window.start_s, 2.0 * kSampleMissionDurationS);
  EXPECT_EQ(model->window.rejected.Total(), 0u);
}

TEST_F(CommandTest, MalformedRowsAreNotedWithTheirLines) {
  const std::string gnss = TextOfFile(Path("log/gnss.csv"));
  folder.Write("log/gnss.csv", gnss + "600.5,oops,1\n");
  const CommandOutcome outcome = Identify({});
  EXPECT_EQ(outcome.exit_code, kExitSuccess);
  const auto line = std::count(gnss.begin(), gnss.end(), '\n') + 1;
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("gnss.csv: 1 malformed rows skipped"),
                                 HasSubstr("line " + std::to_string(line))));
}

TEST_F(CommandTest, ALogWithoutAFileIsRefusedWithReasonAndAdvice) {
  std::filesystem::remove(Path("log/heading.csv"));
  const CommandOutcome outcome = Identify({"--out", Path("model.json")});
  EXPECT_EQ(outcome.exit_code, kExitRefused);
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("heading.csv: is missing"), HasSubstr("-> ")));
  EXPECT_FALSE(std::filesystem::exists(Path("model.json")));
}

TEST_F(CommandTest, AnEmptyOrShortLogIsRefused) {
  folder.Write("log/gnss.csv", "");
  EXPECT_EQ(Identify({}).exit_code, kExitRefused);
  folder.Write("log/gnss.csv", "time_s,latitude_deg,longitude_deg\n0,1,1\n0.2,1,1\n");
  const CommandOutcome outcome = Identify({});
  EXPECT_EQ(outcome.exit_code, kExitRefused);
  EXPECT_THAT(outcome.err, HasSubstr("-> "));
}

TEST_F(CommandTest, AWrongVehicleFileFailsNamingFieldAndLine) {
  folder.Write("boat.textproto", "vehicle_id: \"b\"\npropeller_separation_m: 900\n");
  const CommandOutcome outcome = Identify({});
  EXPECT_EQ(outcome.exit_code, kExitFailure);
  EXPECT_THAT(outcome.err,
              HasSubstr("boat.textproto:2: propeller_separation_m = 900: a number in [0.05, 50]"));
}

TEST_F(CommandTest, AModelThatCannotBeWrittenFails) {
  const CommandOutcome outcome = Identify({"--out", Path("nowhere/model.json")});
  EXPECT_EQ(outcome.exit_code, kExitFailure);
  EXPECT_THAT(outcome.err, HasSubstr("nowhere/model.json"));
}

// ---- validate --------------------------------------------------------------------------------

TEST_F(CommandTest, ValidateScoresTheModelBesideConstantVelocity) {
  MakeModel();
  const CommandOutcome outcome = Validate({"--out", Path("metrics.json")});
  EXPECT_EQ(outcome.exit_code, kExitSuccess) << outcome.err;
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("constant velocity"), HasSubstr("noise floor"),
                                 HasSubstr("1 s:"), HasSubstr("5 s:"), HasSubstr("10 s:")));
  const auto metrics = ParseMetricsJson(TextOfFile(Path("metrics.json")));
  ASSERT_TRUE(metrics) << metrics.error().Message();
  EXPECT_EQ(metrics->free_run.size(), 3u);
}

TEST_F(CommandTest, ValidateTakesHorizons) {
  MakeModel();
  const CommandOutcome outcome = Validate({"--horizon", "2", "--horizon", "3", "--json"});
  const auto metrics = ParseMetricsJson(outcome.out);
  ASSERT_TRUE(metrics) << metrics.error().Message();
  ASSERT_EQ(metrics->free_run.size(), 2u);
  EXPECT_EQ(metrics->free_run[1].horizon_s, 3.0);
  EXPECT_EQ(Validate({"--horizon", "-1"}).exit_code, kExitUsage);
  EXPECT_EQ(Validate({"--horizon", "601"}).exit_code, kExitUsage);
  const CommandOutcome too_short = Validate({"--horizon", "0.1"});
  EXPECT_EQ(too_short.exit_code, kExitUsage);
  EXPECT_THAT(too_short.err, HasSubstr("--horizon 0.1 must be within ["));
}

TEST_F(CommandTest, ValidateWritesTheDisturbanceOverTheLog) {
  MakeModel();
  const CommandOutcome outcome = Validate({"--disturbance", Path("sigma.csv")});
  ASSERT_EQ(outcome.exit_code, kExitSuccess) << outcome.err;
  std::vector<std::array<double, 4>> rows;
  const std::array<std::string_view, 4> columns = {"time_s", "sigma_u", "sigma_v", "sigma_r"};
  ASSERT_TRUE(ReadCsv(Path("sigma.csv"), columns, [&](std::span<const double> row) {
    rows.push_back({row[0], row[1], row[2], row[3]});
  }));

  const auto model = ParseModelJson(TextOfFile(Path("model.json")));
  const auto recorded = LoadRecording(std::filesystem::path(Path("log")));
  const auto dataset = Prepare(recorded->recording, YellowfishVehicle(), PrepareOptions::Robust());
  const auto expected = ReconstructDisturbance(*dataset, *ModelOf(*model));
  ASSERT_EQ(rows.size(), expected.size());
  ASSERT_GT(rows.size(), 2900u);
  for (std::size_t k = 0; k < rows.size(); ++k) {
    EXPECT_EQ(rows[k][0], expected[k].time_s);
    EXPECT_EQ(rows[k][1], expected[k].sigma.u);
    EXPECT_EQ(rows[k][2], expected[k].sigma.v);
    EXPECT_EQ(rows[k][3], expected[k].sigma.r);
  }
  EXPECT_EQ(Validate({"--disturbance", Path("nowhere/sigma.csv")}).exit_code, kExitFailure);
}

TEST_F(CommandTest, ValidateSaysWhetherTheLogMadeTheModel) {
  MakeModel();
  EXPECT_THAT(Validate({}).out, HasSubstr("these may be scores on"));
  WriteTelemetryLog(Path("log"), Measured(5000.0));
  EXPECT_THAT(Validate({}).out, HasSubstr("not among the data that made the model"));
}

TEST_F(CommandTest, ValidateRefusesAModelThatLacksAnEquation) {
  Identification partial = MadeUpIdentification();
  std::erase_if(partial.coefficients, [](const auto& c) { return c.equation == Equation::kSway; });
  const auto n = static_cast<Eigen::Index>(partial.coefficients.size());
  partial.covariance = Eigen::MatrixXd::Identity(n, n);
  folder.Write("model.json", PrintModelJson(partial));
  const CommandOutcome outcome = Validate({});
  EXPECT_EQ(outcome.exit_code, kExitRefused);
  EXPECT_THAT(outcome.err, HasSubstr("-> "));
}

TEST_F(CommandTest, AWrongModelFileFailsNamingTheField) {
  folder.Write("model.json", "{\"structure\": \"CUBIC\"}");
  const CommandOutcome outcome = Validate({});
  EXPECT_EQ(outcome.exit_code, kExitFailure);
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("structure"), HasSubstr("CUBIC")));
}

TEST_F(CommandTest, AModelOfAnotherVehicleIsNoted) {
  folder.Write("model.json", PrintModelJson(MadeUpIdentification()));
  EXPECT_THAT(Validate({}).err, HasSubstr("the model is of made-up.1"));
}

// ---- simulate --------------------------------------------------------------------------------

TEST_F(CommandTest, SimulateWritesALogOfTheSameCommands) {
  MakeModel();
  const CommandOutcome outcome = Simulated({"--out", Path("simulated")});
  EXPECT_EQ(outcome.exit_code, kExitSuccess) << outcome.err;
  const auto given = ReadTelemetryLog(Path("log"));
  const auto made = ReadTelemetryLog(Path("simulated"));
  ASSERT_TRUE(made) << made.error().reason;
  EXPECT_EQ(TextOfFile(Path("simulated/thrusters.csv")), TextOfFile(Path("log/thrusters.csv")));
  EXPECT_EQ(made->channels.thrusters.back().time_s, given->channels.thrusters.back().time_s);
}

TEST_F(CommandTest, TheSameSeedSimulatesTheSameLog) {
  MakeModel();
  const auto gnss = [this](const char* seed, const char* out) {
    EXPECT_EQ(Simulated({"--seed", seed, "--out", Path(out)}).exit_code, kExitSuccess);
    return TextOfFile(folder.Path() / out / "gnss.csv");
  };
  const std::string first = gnss("7", "a");
  EXPECT_EQ(gnss("7", "b"), first);
  EXPECT_NE(gnss("8", "c"), first);
}

TEST_F(CommandTest, SimulateRefusesAModelThatDiverges) {
  Identification unstable = MadeUpIdentification();
  unstable.coefficients[0].estimate = 50.0;  // u|u| that drives instead of damping
  unstable.coefficients[4].estimate = 1.0;   // and a push to begin with
  folder.Write("model.json", PrintModelJson(unstable));
  const CommandOutcome outcome = Simulated({"--out", Path("simulated")});
  EXPECT_EQ(outcome.exit_code, kExitRefused);
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("grows without bound"), HasSubstr("-> ")));
  EXPECT_FALSE(std::filesystem::exists(Path("simulated")));
}

TEST_F(CommandTest, SimulateChecksItsInputs) {
  MakeModel();
  EXPECT_EQ(Simulated({"--out", Path("s"), "--step", "0"}).exit_code, kExitUsage);
  EXPECT_EQ(Simulated({"--out", Path("s"), "--noise-position", "-1"}).exit_code, kExitUsage);
  EXPECT_EQ(Simulated({"--out", Path("s"), "--noise-heading", "91"}).exit_code, kExitUsage);
  EXPECT_EQ(Simulated({"--out", Path("s"), "--seed", "-1"}).exit_code, kExitUsage);
  EXPECT_EQ(Simulated({"--out", Path("boat.textproto")}).exit_code, kExitFailure);
  folder.Write("log/thrusters.csv", "time_s,left_us,right_us\n0,9999,1500\n");
  EXPECT_EQ(Simulated({"--out", Path("s")}).exit_code, kExitRefused);
}

// ---- export ----------------------------------------------------------------------------------

class ExportTest : public CommandTest {
 protected:
  ExportTest() {
    Identification model = MadeUpIdentification();
    model.vehicle_id = "yellowfish";
    folder.Write("model.json", PrintModelJson(model));
    Vehicle vehicle = YellowfishVehicle();
    vehicle.mass_kg.reset();
    folder.Write("massless.textproto", PrintVehicle(vehicle));
  }

  CommandOutcome Export(const std::string& vehicle, std::vector<std::string> more) const {
    std::vector<std::string> arguments = {"export", "--model", Path("model.json"), "--vehicle",
                                          Path(vehicle)};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return Telltale(arguments);
  }
};

TEST_F(ExportTest, WritesAFileOrIntoAFolder) {
  const std::string boat = "massless.textproto";
  EXPECT_EQ(Export(boat, {"--format", "mss", "--out", Path("boat.json")}).exit_code, kExitSuccess);
  EXPECT_THAT(TextOfFile(Path("boat.json")), HasSubstr("notIdentifiable"));
  EXPECT_EQ(Export(boat, {"--format", "mss", "--out", folder.Path().string()}).exit_code,
            kExitSuccess);
  EXPECT_EQ(TextOfFile(Path("mss.json")), TextOfFile(Path("boat.json")));
  EXPECT_EQ(Export(boat, {"--format", "mss", "--out", Path("new/")}).exit_code, kExitSuccess);
  EXPECT_EQ(TextOfFile(Path("new/mss.json")), TextOfFile(Path("boat.json")));
  const CommandOutcome outcome =
      Export(boat, {"--format", "mss", "--draws", "5", "--out", Path("boat.json")});
  EXPECT_EQ(outcome.exit_code, kExitUsage);
  EXPECT_THAT(outcome.err, HasSubstr("boat.json is a file; give a folder"));
}

TEST_F(ExportTest, WritesTheSimulationParametersAndNotesIt) {
  Identification model = MadeUpIdentificationWithSimulationParameters();
  model.vehicle_id = "yellowfish";
  model.simulation[0] = -0.0625;
  folder.Write("model.json", PrintModelJson(model));
  const CommandOutcome outcome =
      Export("massless.textproto", {"--format", "mss", "--out", Path("boat.json")});
  EXPECT_EQ(outcome.exit_code, kExitSuccess);
  EXPECT_THAT(outcome.err, HasSubstr("as estimated the model diverges"));
  EXPECT_THAT(TextOfFile(Path("boat.json")), HasSubstr("\"estimate\": -0.0625"));
}

TEST_F(ExportTest, TheSameSeedDrawsTheSameBits) {
  const auto draws = [this](const char* seed, const char* out) {
    const CommandOutcome outcome =
        Export("massless.textproto",
               {"--format", "mss", "--draws", "20", "--seed", seed, "--out", Path(out)});
    EXPECT_EQ(outcome.exit_code, kExitSuccess) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr("SURGE vr is not drawn"));
    EXPECT_THAT(TextOfFile(folder.Path() / out / "draws.json"), HasSubstr("notDrawn"));
    return TextOfFile(folder.Path() / out / "draws.csv");
  };
  const std::string first = draws("7", "a");
  EXPECT_EQ(std::count(first.begin(), first.end(), '\n'), 21);
  EXPECT_EQ(draws("7", "b"), first);
  EXPECT_NE(draws("8", "c"), first);
}

TEST_F(ExportTest, VrxWithoutAMassIsRefusedAndLeavesNothing) {
  const CommandOutcome outcome =
      Export("massless.textproto", {"--format", "vrx", "--draws", "5", "--out", Path("exported")});
  EXPECT_EQ(outcome.exit_code, kExitRefused);
  EXPECT_THAT(outcome.err,
              AllOf(HasSubstr("mass_kg"), HasSubstr("-> measure the mass of the boat")));
  EXPECT_FALSE(std::filesystem::exists(Path("exported")));
}

TEST_F(ExportTest, ChecksItsInputs) {
  const std::string boat = "massless.textproto";
  const std::string out = Path("x");
  for (const std::vector<std::string>& more :
       std::vector<std::vector<std::string>>{{"--out", out},
                                             {"--format", "mss"},
                                             {"--format", "csv", "--out", out},
                                             {"--format", "mss", "--draws", "0", "--out", out},
                                             {"--format", "mss", "--draws", "many", "--out", out},
                                             {"--format", "mss", "--seed", "1", "--out", out}}) {
    EXPECT_EQ(Export(boat, more).exit_code, kExitUsage) << testing::PrintToString(more);
  }
  EXPECT_EQ(Export(boat, {"--format", "mss", "--out", Path("nowhere/x")}).exit_code, kExitFailure);
  EXPECT_FALSE(std::filesystem::exists(out));
}

}  // namespace
}  // namespace telltale
