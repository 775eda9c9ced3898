#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/loopback_domain.hpp"
#include "support/made_up_identifications.hpp"
#include "support/telltale_command.hpp"
#include "support/temporary_folder.hpp"
#include "telltale/client/recording/telemetry_log/telemetry_log.hpp"
#include "telltale/core/base/version.hpp"
#include "telltale/core/paper/yellowfish.hpp"
#include "telltale/idl/codec/json/model.hpp"
#include "telltale/idl/codec/vehicle_file.hpp"

namespace telltale {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

using Words = std::vector<std::string>;

/// A folder with everything that a subcommand may refuse or fail on.
class ExitCodesTest : public testing::Test {
 protected:
  ExitCodesTest() {
    Vehicle massless = YellowfishVehicle();
    massless.mass_kg.reset();
    boat = folder.Write("boat.textproto", PrintVehicle(massless)).string();
    not_a_boat = folder.Write("not-a-boat.textproto", "propeller_separation_m: 900\n").string();
    not_a_model = folder.Write("not-a-model.json", "{\"structure\": \"CUBIC\"}").string();
    empty_log = (folder.Path() / "empty").string();
    WriteTelemetryLog(empty_log, {});
    commands = folder
                   .Write("commands.csv",
                          "time_s,left_us,right_us\n0,1800,1800\n30,1800,1800\n60,1800,1800\n")
                   .string();
    Identification made = MadeUpIdentification();
    model = folder.Write("model.json", PrintModelJson(made)).string();
    made.sampling_period_s = 0.5;
    other_model = folder.Write("other.json", PrintModelJson(made)).string();
    std::erase_if(made.coefficients, [](const auto& c) { return c.equation == Equation::kSway; });
    const auto n = static_cast<Eigen::Index>(made.coefficients.size());
    made.covariance = Eigen::MatrixXd::Identity(n, n);
    partial_model = folder.Write("partial.json", PrintModelJson(made)).string();
    out = (folder.Path() / "out").string();
  }

  void Expect(int exit_code, const std::vector<Words>& command_lines) const {
    for (const Words& words : command_lines) {
      const CommandOutcome outcome = Telltale(words);
      EXPECT_EQ(outcome.exit_code, exit_code) << testing::PrintToString(words) << outcome.err;
      EXPECT_THAT(outcome.err, Not(IsEmpty())) << testing::PrintToString(words);
    }
  }

  const Words subcommands = {"identify", "validate", "diagnose", "simulate", "export", "gain",
                             "compare",  "replay",   "watch",    "monitor",  "study"};
  LoopbackDomain domain;
  TemporaryFolder folder;
  std::string boat, not_a_boat, model, other_model, partial_model, not_a_model, empty_log, commands,
      out;
};

TEST_F(ExitCodesTest, HelpAndVersionSucceed) {
  for (const std::string& subcommand : subcommands) {
    const CommandOutcome outcome = Telltale({subcommand, "--help"});
    EXPECT_EQ(outcome.exit_code, kExitSuccess) << subcommand;
    EXPECT_THAT(outcome.out, HasSubstr("Example")) << subcommand;
    EXPECT_THAT(outcome.err, IsEmpty()) << subcommand;
  }
  const CommandOutcome version = Telltale({"--version"});
  EXPECT_EQ(version.exit_code, kExitSuccess);
  EXPECT_EQ(version.out, "telltale " + std::string(Version()) + "\n");
}

TEST_F(ExitCodesTest, AnUnknownOptionIsAUsageError) {
  for (const std::string& subcommand : subcommands) {
    EXPECT_EQ(Telltale({subcommand, "--colour", "red"}).exit_code, kExitUsage) << subcommand;
  }
}

TEST_F(ExitCodesTest, WhatTheDataCannotAnswerIsARefusal) {
  Expect(kExitRefused,
         {{"identify", "--log", empty_log, "--vehicle", boat},
          {"validate", "--log", empty_log, "--vehicle", boat, "--model", partial_model},
          {"diagnose", "--log", empty_log, "--vehicle", boat, "--model", model},
          {"simulate", "--model", partial_model, "--vehicle", boat, "--commands", commands, "--out",
           out},
          {"export", "--model", model, "--vehicle", boat, "--format", "vrx", "--out", out},
          {"compare", "--model", model, "--model", other_model},
          {"replay", "--log", empty_log, "--vehicle-id", "boat"},
          {"study", "--log", empty_log, "--vehicle", boat}});
}

TEST_F(ExitCodesTest, EverythingElseIsAFailure) {
  Expect(kExitFailure,
         {{"identify", "--log", empty_log, "--vehicle", not_a_boat},
          {"validate", "--log", empty_log, "--vehicle", boat, "--model", not_a_model},
          {"diagnose", "--log", empty_log, "--vehicle", boat, "--model", not_a_model},
          {"simulate", "--model", not_a_model, "--vehicle", boat, "--commands", commands, "--out",
           out},
          {"export", "--model", not_a_model, "--vehicle", boat, "--format", "mss", "--out", out},
          {"gain", "--model", not_a_model},
          {"compare", "--model", model, "--model", not_a_model},
          {"study", "--log", empty_log, "--vehicle", not_a_boat}});
}

TEST_F(ExitCodesTest, ValuesOutsideTheirRangeAreUsageErrors) {
  Expect(kExitUsage, {{"study", "--log", empty_log, "--sampling-period", "5"},
                      {"monitor", "--verdict", "FOO"},
                      {"monitor", "--sort", "2"}});
  const CommandOutcome outcome =
      RunCommand({"sh", "-c", std::string(TELLTALE_COMMAND) + " monitor --verdict FOO"});
  EXPECT_THAT(outcome.err, HasSubstr("FOO not in {OK,WARN,ERROR,STALE}"));
}

TEST_F(ExitCodesTest, WithoutADaemonTheLiveSubcommandsFail) {
  const std::string id = std::to_string(domain.id());
  Expect(kExitFailure, {{"watch", "--all", "--domain", id, "--timeout", "0.2"},
                        {"monitor", "--domain", id, "--timeout", "0.2"},
                        {"identify", "--vehicle-id", "boat", "--domain", id, "--timeout", "0.2"},
                        {"diagnose", "--vehicle-id", "boat", "--domain", id, "--timeout", "0.2"}});
}

TEST_F(ExitCodesTest, StandardOutputThatCannotBeWrittenIsAFailure) {
  const CommandOutcome outcome = RunCommand(
      {"sh", "-c", std::string(TELLTALE_COMMAND) + " gain --model " + model + " > /dev/full"});
  EXPECT_EQ(outcome.exit_code, kExitFailure);
  EXPECT_THAT(outcome.err, HasSubstr("standard output"));
}

/// Ceres, Protobuf and Cyclone DDS write to standard error on their own; none of it gets through.
TEST_F(ExitCodesTest, StandardErrorHoldsOurLinesAlone) {
  const CommandOutcome outcome =
      RunCommand({"env", "GLOG_minloglevel=0", "GLOG_v=2", TELLTALE_COMMAND, "identify", "--log",
                  std::string(TELLTALE_SOURCE_DIR) + "/deploy/sample", "--vehicle",
                  std::string(TELLTALE_SOURCE_DIR) + "/deploy/sample/yellowfish.textproto",
                  "--structure", "dynamic", "--estimator", "output-error"});
  EXPECT_EQ(outcome.exit_code, kExitSuccess);
  EXPECT_THAT(outcome.err, IsEmpty());
}

}  // namespace
}  // namespace telltale
