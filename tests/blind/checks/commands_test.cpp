#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "support/run_command.hpp"
#include "support/temporary_folder.hpp"

namespace blind {
namespace {

using telltale::CommandOutcome;
using telltale::RunCommand;
using telltale::TemporaryFolder;
using testing::HasSubstr;

CommandOutcome Truth(const std::vector<std::string>& options) {
  std::vector<std::string> words{BLIND_TRUTH};
  words.insert(words.end(), options.begin(), options.end());
  return RunCommand(words);
}

TEST(BlindCommands, HelpThemselves) {
  for (const char* command :
       {BLIND_TRUTH, BLIND_SCORE, BLIND_FIT, BLIND_ALTER, BLIND_BASELINES, BLIND_REALISED}) {
    const CommandOutcome outcome = RunCommand({command, "--help"});
    EXPECT_EQ(outcome.exit_code, 0) << command;
    EXPECT_THAT(outcome.out, HasSubstr("Example: ")) << command;
  }
}

TEST(BlindTruth, RefusesBadOptionsByName) {
  const TemporaryFolder folder;
  const std::string out = folder.Path().string();
  const std::vector<std::pair<std::vector<std::string>, std::string>> wrong{
      {{"--no-such-option"}, "--no-such-option"},
      {{}, "--out"},
      {{"--out", out, "--set", "third"}, "--set"},
      {{"--out", out, "--duration", "1"}, "--duration"},
      {{"--out", out, "--effect", "gremlins"}, "no effect gremlins; there are wind,"},
      {{"--out", out, "--nominal", "--hull", "bounty"}, "no hull bounty"},
      {{"--out", out, "--nominal", "--effect", "wind"}, "--nominal"},
      {{"--out", out, "--hull", "tern"}, "--hull"},
      {{"--out", out, "--effect", "wind", "--sign", "0"}, "--sign"},
      {{"--out", out, "--effect", "wind", "--size", "1", "--size", "2"}, "--size"}};
  for (const auto& [options, name] : wrong) {
    const CommandOutcome outcome = Truth(options);
    EXPECT_EQ(outcome.exit_code, 2) << name;
    EXPECT_THAT(outcome.err, HasSubstr(name));
  }
}

TEST(BlindTruth, TellsTheLabelOnlyWhenAsked) {
  const TemporaryFolder folder;
  const std::vector<std::string> options{"--effect", "wind",  "--duration",
                                         "10",       "--out", folder.Path().string()};
  EXPECT_EQ(Truth(options).out, "");
  std::vector<std::string> unsealing = options;
  unsealing.push_back("--unseal");
  EXPECT_THAT(Truth(unsealing).out, HasSubstr("\"effect\":\"wind\""));
}

TEST(BlindScore, SaysWhichReportsAreMissing) {
  const TemporaryFolder folder;
  folder.Write("set/cases/001/hull", "tern\n");
  folder.Write("reports/other.txt", "");
  const CommandOutcome outcome =
      RunCommand({BLIND_SCORE, "--set-dir", (folder.Path() / "set").string(), "--reports",
                  (folder.Path() / "reports").string()});
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_THAT(outcome.err, HasSubstr("1 of 1 cases have no report yet (001)"));
  EXPECT_EQ(RunCommand({BLIND_SCORE}).exit_code, 2);
}

TEST(BlindAlter, WritesAnotherLogAndNeverOverTheFirst) {
  const TemporaryFolder folder;
  const std::string log = (folder.Path() / "log").string();
  folder.Write("log/gnss.csv", "time_s,latitude_deg,longitude_deg\n1,45,7\n");
  folder.Write("log/heading.csv", "time_s,heading_deg\n1,20\n");
  folder.Write("log/thrusters.csv", "time_s,left_us,right_us\n1,1700,1300\n");
  const std::string out = (folder.Path() / "out").string();
  const CommandOutcome outcome = RunCommand(
      {BLIND_ALTER, "--log", log, "--out", out, "--turn-heading-deg", "4", "--delay-fixes-s", "0.4",
       "--shift-commands-s", "0.3", "--weaken", "starboard", "0.36", "--move-antenna-m", "0", "0"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(telltale::TextOfFile(out + "/heading.csv"), HasSubstr("1.000000,24.000000"));
  EXPECT_THAT(telltale::TextOfFile(out + "/gnss.csv"), HasSubstr("1.400000,45.0000000000,7"));
  // -0.5 / sqrt(0.64) = -0.625 of 400 us
  EXPECT_THAT(telltale::TextOfFile(out + "/thrusters.csv"),
              HasSubstr("0.700000,1700.000,1250.000"));

  const auto refused = [&](std::vector<std::string> options) {
    options.insert(options.begin(), {BLIND_ALTER, "--log", log});
    return RunCommand(options).exit_code;
  };
  EXPECT_EQ(refused({"--out", log}), 2);
  EXPECT_EQ(refused({"--out", out, "--weaken", "bow", "0.2"}), 2);
  EXPECT_EQ(refused({"--out", out, "--weaken", "port", "2"}), 2);
  EXPECT_EQ(refused({"--out", out, "--weaken", "port", "0.2", "--port-pulses-us", "1500", "1900",
                     "1800"}),
            2);
}

}  // namespace
}  // namespace blind
