#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "support/dataflash_writer.hpp"
#include "support/telltale_command.hpp"
#include "support/temporary_folder.hpp"
#include "telltale/client/recording/telemetry_log/telemetry_log.hpp"
#include "telltale/core/paper/sample_mission.hpp"
#include "telltale/core/paper/yellowfish.hpp"
#include "telltale/core/simulation/manoeuvres.hpp"
#include "telltale/core/simulation/sensors.hpp"
#include "telltale/idl/codec/json/model.hpp"
#include "telltale/idl/codec/vehicle_file.hpp"

namespace telltale {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

/// The twin with a reversed starboard channel, its antenna above the body origin.
Vehicle Boat() {
  Vehicle vehicle = YellowfishVehicle();
  vehicle.vehicle_id = "boat-7";
  vehicle.starboard = {1500.0, 1100.0, 1900.0};
  vehicle.gnss_antenna = {};
  return vehicle;
}

Recording Measured(double start_s) {
  auto commands = SampleMission(1);
  for (TimedCommand& command : commands) command.time_s += start_s;
  const auto track =
      Simulate(YellowfishTwin(), {}, commands, start_s + kSampleMissionDurationS, 0.02);
  return Measure(track, Boat(), {});
}

std::uint64_t Microseconds(double time_s) {
  return static_cast<std::uint64_t>(std::llround(1e6 * time_s));
}

/// What an autopilot would have logged of a recording: port on channel 3, starboard on channel 1,
/// whose servo range is `starboard_min_us` to 1900.
Rover4Writer Logged(const Recording& recording, float starboard_min_us = 1100.0f) {
  Rover4Writer log;
  log.Definitions().Units();
  log.Output(3, 73, 1100, 1500, 1900, false);
  log.Output(1, 74, starboard_min_us, 1500, 1900, true);
  for (const GnssFix& fix : recording.gnss) {
    log.Gps(Microseconds(fix.time_s), 0, 3, std::llround(1e7 * fix.latitude_deg),
            std::llround(1e7 * fix.longitude_deg));
  }
  for (const HeadingSample& sample : recording.heading) {
    log.Att(Microseconds(sample.time_s), static_cast<int>(std::lround(100 * sample.heading_deg)));
  }
  for (const ThrusterSample& sample : recording.thrusters) {
    log.Rcou(Microseconds(sample.time_s), static_cast<int>(std::lround(sample.starboard_us)), 1500,
             static_cast<int>(std::lround(sample.port_us)));
  }
  return log;
}

class LogInputsTest : public testing::Test {
 protected:
  void Save(const std::string& name, const Rover4Writer& log) const {
    folder.Write(name, std::string(log.Bytes().begin(), log.Bytes().end()));
  }

  std::string Path(const std::string& name) const { return (folder.Path() / name).string(); }

  CommandOutcome Identify(std::vector<std::string> more) const {
    std::vector<std::string> arguments = {"identify", "--bootstrap", "0"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return Telltale(arguments);
  }

  TemporaryFolder folder;
};

TEST_F(LogInputsTest, ADataFlashLogNeedsNoVehicleFile) {
  Save("run 1.BIN", Logged(Measured(100.0)));
  folder.Write("boat.textproto", PrintVehicle(Boat()));
  const CommandOutcome without = Identify({"--log", Path("run 1.BIN"), "--json"});
  ASSERT_EQ(without.exit_code, kExitSuccess) << without.err;
  EXPECT_THAT(without.err,
              AllOf(HasSubstr("vehicle run_1 is taken from"),
                    HasSubstr("port on channel 3, 1100 us (full reverse), 1500 us (neutral), 1900 "
                              "us (full forward)"),
                    HasSubstr("starboard on channel 1, 1900 us (full reverse)"),
                    HasSubstr("unknown, taken as zero")));
  const CommandOutcome with =
      Identify({"--log", Path("run 1.BIN"), "--vehicle", Path("boat.textproto"), "--json"});
  ASSERT_EQ(with.exit_code, kExitSuccess) << with.err;
  EXPECT_THAT(with.err, Not(HasSubstr("is taken from")));

  auto described = ParseModelJson(without.out);
  const auto stated = ParseModelJson(with.out);
  ASSERT_TRUE(described && stated);
  EXPECT_EQ(described->vehicle_id, "run_1");
  described->vehicle_id = "boat-7";
  EXPECT_EQ(PrintModelJson(*described), PrintModelJson(*stated));
}

TEST_F(LogInputsTest, ADataFlashLogIsValidatedAndStudied) {
  Save("a.BIN", Logged(Measured(100.0)));
  Save("b.BIN", Logged(Measured(5000.0)));
  ASSERT_EQ(Identify({"--log", Path("a.BIN"), "--out", Path("model.json")}).exit_code,
            kExitSuccess);
  const CommandOutcome scored =
      Telltale({"validate", "--log", Path("b.BIN"), "--model", Path("model.json")});
  EXPECT_EQ(scored.exit_code, kExitSuccess) << scored.err;
  // Names of files are not names of boats: their difference is nothing to be told.
  EXPECT_THAT(scored.err, Not(HasSubstr("the model is of")));
  const CommandOutcome studied =
      Telltale({"study", "--log", Path("a.BIN"), "--log", Path("b.BIN"), "--partitions", "1"});
  EXPECT_EQ(studied.exit_code, kExitSuccess) << studied.err;
  EXPECT_THAT(studied.err, HasSubstr("vehicle a is taken from"));
}

TEST_F(LogInputsTest, AFolderDoesNeedAVehicleFile) {
  const Recording recording = Measured(100.0);
  WriteTelemetryLog(Path("log"), recording);
  Save("run.BIN", Logged(recording));
  for (const std::vector<std::string>& logs : std::vector<std::vector<std::string>>{
           {"--log", Path("log")}, {"--log", Path("run.BIN"), "--log", Path("log")}}) {
    const CommandOutcome outcome = Identify(logs);
    EXPECT_EQ(outcome.exit_code, kExitUsage);
    EXPECT_THAT(outcome.err, AllOf(HasSubstr("--vehicle is required"), HasSubstr(Path("log"))));
  }
}

TEST_F(LogInputsTest, LogsWithOtherServoRangesAreRefusedNamingBoth) {
  Save("a.BIN", Logged(Measured(100.0)));
  Save("b.BIN", Logged(Measured(5000.0), 1050.0f));
  const CommandOutcome outcome = Identify({"--log", Path("a.BIN"), "--log", Path("b.BIN")});
  EXPECT_EQ(outcome.exit_code, kExitRefused);
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("a.BIN"), HasSubstr("b.BIN"), HasSubstr("starboard"),
                                 HasSubstr("1050 us"), HasSubstr("-> give a vehicle file")));
  folder.Write("boat.textproto", PrintVehicle(Boat()));
  EXPECT_EQ(Identify({"--log", Path("a.BIN"), "--log", Path("b.BIN"), "--vehicle",
                      Path("boat.textproto")})
                .exit_code,
            kExitSuccess);
}

TEST_F(LogInputsTest, ALogWithoutServoRangesIsRefusedNamingIt) {
  Rover4Writer log;
  log.Definitions().Parm("SERVO3_FUNCTION", 73).Parm("SERVO1_FUNCTION", 74).Run(100);
  Save("unsaid.BIN", log);
  const CommandOutcome outcome = Identify({"--log", Path("unsaid.BIN")});
  EXPECT_EQ(outcome.exit_code, kExitRefused);
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("unsaid.BIN port thruster"), HasSubstr("SERVO3_MIN"),
                                 HasSubstr("-> give a vehicle file")));
}

TEST_F(LogInputsTest, ReceiverAndChannelsCanBeChosen) {
  const Recording recording = Measured(100.0);
  Rover4Writer log = Logged(recording);
  log.Gps(Microseconds(110.0), 1, 3, 374205000, -59944000);
  Save("run.BIN", log);
  EXPECT_THAT(Identify({"--log", Path("run.BIN")}).err, HasSubstr("GPS instance 0"));
  const CommandOutcome second = Identify({"--log", Path("run.BIN"), "--gps-instance", "1"});
  EXPECT_EQ(second.exit_code, kExitRefused);  // one fix is no track
  EXPECT_THAT(second.err, HasSubstr("GPS instance 1"));
  const CommandOutcome absent = Identify({"--log", Path("run.BIN"), "--gps-instance", "2"});
  EXPECT_EQ(absent.exit_code, kExitRefused);
  EXPECT_THAT(absent.err, HasSubstr("ask for one of: 0 1"));

  // Thrusters taken for each other: port is then the reversed channel.
  const CommandOutcome swapped =
      Identify({"--log", Path("run.BIN"), "--port-channel", "1", "--starboard-channel", "3",
                "--skip-input-check", "--json"});
  EXPECT_EQ(swapped.exit_code, kExitSuccess) << swapped.err;
  EXPECT_THAT(swapped.err, AllOf(HasSubstr("port on channel 1, 1900 us (full reverse)"),
                                 HasSubstr("starboard on channel 3, 1100 us (full reverse)")));
}

TEST_F(LogInputsTest, OptionsOfDataFlashLogsAreChecked) {
  Save("run.BIN", Rover4Writer().WholeLog(5));
  for (const auto& [option, value, range] : {std::array{"--gps-instance", "256", "[0, 255]"},
                                             std::array{"--port-channel", "0", "[1, 16]"},
                                             std::array{"--starboard-channel", "15", "[1, 16]"}}) {
    for (const char* subcommand : {"identify", "study"}) {
      const CommandOutcome outcome =
          Telltale({subcommand, "--log", Path("run.BIN"), option, value});
      EXPECT_EQ(outcome.exit_code, kExitUsage) << option;
      EXPECT_THAT(outcome.err, HasSubstr(option));
    }
    EXPECT_EQ(Telltale({"replay", "--log", Path("run.BIN"), "--vehicle-id", "b", option, value})
                  .exit_code,
              kExitUsage);
    EXPECT_THAT(Telltale({"replay", "--help"}).out, AllOf(HasSubstr(option), HasSubstr(range)));
  }
  EXPECT_EQ(Telltale({"identify", "--vehicle-id", "b", "--gps-instance", "1"}).exit_code,
            kExitUsage);
}

TEST_F(LogInputsTest, AChannelThatALogDoesNotRecordIsAUsageError) {
  Save("run.BIN", Rover4Writer().WholeLog(5));
  for (const char* subcommand : {"identify", "check", "import", "init"}) {
    const CommandOutcome outcome = Telltale(
        {subcommand, "--log", Path("run.BIN"), "--port-channel", "15", "--out", Path("written")});
    EXPECT_EQ(outcome.exit_code, kExitUsage) << subcommand;
    EXPECT_THAT(outcome.err, AllOf(HasSubstr("--port-channel"), HasSubstr("channels 1 to 14")));
  }
}

TEST_F(LogInputsTest, CheckShowsTheChannelsThatAreThereAndNamesTheOthers) {
  Rover4Writer log;
  log.Definitions().Att(1'000'000, 9000).Att(1'100'000, 9000);
  Save("run.BIN", log);
  const CommandOutcome outcome = Telltale({"check", "--log", Path("run.BIN")});
  EXPECT_EQ(outcome.exit_code, kExitRefused);
  EXPECT_THAT(outcome.out,
              AllOf(HasSubstr("heading        2  10.0"), HasSubstr("Missing, gnss: no GPS message"),
                    HasSubstr("To do: enable GPS"), HasSubstr("Missing, thrusters"),
                    HasSubstr("Delays between the channels are unknown")));
  EXPECT_THAT(outcome.err, HasSubstr("run.BIN gnss: no GPS message"));
  const auto json =
      nlohmann::json::parse(Telltale({"check", "--log", Path("run.BIN"), "--json"}).out);
  EXPECT_EQ(json["logs"][0]["missing"].size(), 2u);
  EXPECT_EQ(json["logs"][0]["delays"]["unknown"]["subject"], "delays");
}

TEST_F(LogInputsTest, CheckShowsTheChannelsOfAFolderThatLacksAFile) {
  WriteTelemetryLog(Path("log"), Measured(0.0));
  std::filesystem::remove(Path("log/thrusters.csv"));
  const CommandOutcome outcome = Telltale({"check", "--log", Path("log")});
  EXPECT_EQ(outcome.exit_code, kExitRefused);
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("gnss"), HasSubstr("Missing, thrusters.csv")));
}

TEST_F(LogInputsTest, CheckCountsTheReadingsThatALogRepeats) {
  folder.Write("boat.textproto", PrintVehicle(Boat()));
  Recording recording = Measured(0.0);
  const std::vector<GnssFix> measured = std::move(recording.gnss);
  recording.gnss.clear();
  for (const GnssFix& fix : measured) {
    for (const double later_s : {0.0, 0.02, 0.04}) {
      recording.gnss.push_back(fix);
      recording.gnss.back().time_s += later_s;
    }
  }
  WriteTelemetryLog(Path("log"), recording);
  const std::string counted = std::to_string(2 * measured.size());
  const std::vector<std::string> check = {"check", "--log", Path("log"), "--vehicle",
                                          Path("boat.textproto")};
  EXPECT_THAT(Telltale(check).out, HasSubstr("gnss " + counted + " REPEATED rejected."));
  std::vector<std::string> as_json = check;
  as_json.push_back("--json");
  const auto rejected = nlohmann::json::parse(Telltale(as_json).out)["logs"][0]["rejected"];
  EXPECT_EQ(rejected.dump(), R"([{"count":)" + counted + R"(,"reason":"REPEATED"}])");
}

TEST_F(LogInputsTest, CheckSaysTheDelaysOfTheModelThatIdentifyMakes) {
  folder.Write("boat.textproto", PrintVehicle(Boat()));
  WriteTelemetryLog(Path("log"), Measured(0.0));
  const std::vector<std::string> what = {"--log", Path("log"), "--vehicle", Path("boat.textproto"),
                                         "--json"};
  const auto run = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.end(), what.begin(), what.end());
    const CommandOutcome outcome = Telltale(arguments);
    EXPECT_EQ(outcome.exit_code, kExitSuccess) << outcome.err;
    return nlohmann::json::parse(outcome.out);
  };
  const auto checked = run({"check"})["logs"][0]["delays"];
  const auto model = run({"identify", "--structure", "fossen"})["delays"];
  for (const char* channel : {"commands", "fixes"}) {
    EXPECT_EQ(checked[channel]["estimate"], model[channel]["estimate"]) << channel;
    EXPECT_EQ(checked[channel]["interval"], model[channel]["interval"]) << channel;
  }
}

TEST_F(LogInputsTest, DelaysNeedTheDistanceBetweenThePropellers) {
  Save("run.BIN", Logged(Measured(100.0)));
  const CommandOutcome outcome = Telltale({"check", "--log", Path("run.BIN")});
  EXPECT_EQ(outcome.exit_code, kExitSuccess) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("the distance between the propellers is\nnot known"));
  const CommandOutcome refused =
      Telltale({"identify", "--log", Path("run.BIN"), "--structure", "fossen"});
  EXPECT_EQ(refused.exit_code, kExitRefused);
  EXPECT_THAT(refused.err, HasSubstr("propeller_separation_m"));
}

TEST_F(LogInputsTest, InitTakesTheParametersOfALogWithoutPositions) {
  Rover4Writer log;
  log.Definitions().Output(3, 73, 1100, 1490, 1900, false).Parm("SERVO1_FUNCTION", 74);
  Save("run.BIN", log);
  const CommandOutcome outcome =
      Telltale({"init", "--log", Path("run.BIN"), "--out", Path("boat.textproto")});
  EXPECT_EQ(outcome.exit_code, kExitSuccess) << outcome.err;
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("how the starboard thruster is driven: no SERVO1_MIN"),
                                 Not(HasSubstr("port thruster")), HasSubstr("lacks a channel")));
  std::ifstream file(Path("boat.textproto"));
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  EXPECT_THAT(text, HasSubstr("neutral_us: 1490"));
  EXPECT_THAT(text, HasSubstr("channel 3 of run.BIN"));
}

TEST_F(LogInputsTest, AFileOfNoKnownFormatIsRefusedWithTheFormatsThereAre) {
  folder.Write("notes.txt", "Rain since noon.\n");
  const CommandOutcome outcome = Telltale({"check", "--log", Path("notes.txt")});
  EXPECT_EQ(outcome.exit_code, kExitRefused);
  for (const char* format : {"notes.txt", ".BIN", ".tlog", ".mcap", "rosbag2", "CSV"}) {
    EXPECT_THAT(outcome.err, HasSubstr(format));
  }
  folder.Write("empty.BIN", "");
  EXPECT_THAT(Telltale({"check", "--log", Path("empty.BIN")}).err, HasSubstr("is empty"));
}

TEST_F(LogInputsTest, SeveralLogsHaveARecordingBiasEachByDefault) {
  WriteTelemetryLog(Path("one"), Measured(0.0));
  WriteTelemetryLog(Path("two"), Measured(1000.0));
  folder.Write("boat.textproto", PrintVehicle(Boat()));
  const auto identify = [&](std::vector<std::string> more) {
    std::vector<std::string> arguments = {"identify",  "--log",     Path("one"),           "--log",
                                          Path("two"), "--vehicle", Path("boat.textproto")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return Telltale(arguments);
  };
  const CommandOutcome own = identify({"--replicates", "0", "--json"});
  ASSERT_EQ(own.exit_code, kExitSuccess) << own.err;
  EXPECT_EQ(ParseModelJson(own.out)->recording_bias.size(), 2u);
  const CommandOutcome shared =
      identify({"--replicates", "0", "--json", "--recording-bias", "shared"});
  EXPECT_TRUE(ParseModelJson(shared.out)->recording_bias.empty());
  const CommandOutcome table =
      identify({"--replicates", "0", "--recording-bias", "per-recording-ned"});
  EXPECT_THAT(table.out, AllOf(HasSubstr("bias of recording 2"), HasSubstr("cos(psi)")));
  const CommandOutcome one_step =
      identify({"--bootstrap", "0", "--recording-bias", "per-recording"});
  EXPECT_EQ(one_step.exit_code, kExitUsage);
  EXPECT_THAT(one_step.err, HasSubstr("not estimated by one-step; choose weak-iv"));
}

}  // namespace
}  // namespace telltale
