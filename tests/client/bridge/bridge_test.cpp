#include <fcntl.h>
#include <signal.h>
#include <stdlib.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "support/loopback_domain.hpp"
#include "support/mavlink_boats.hpp"
#include "support/process.hpp"
#include "support/telemetry_receiver.hpp"
#include "support/temporary_folder.hpp"
#include "telltale/core/base/degrees.hpp"

namespace telltale {
namespace {

using namespace std::chrono_literals;

constexpr double kSenderBootS = 1.7e9;  // of send_live.mjs
constexpr double kDataBeginS = kSenderBootS + 9.9995;

/// A serial line with nothing at its other end.
class PseudoTerminal {
 public:
  PseudoTerminal() : end_(posix_openpt(O_RDWR | O_NOCTTY)) {
    EXPECT_EQ(grantpt(end_), 0);
    EXPECT_EQ(unlockpt(end_), 0);
  }
  PseudoTerminal(const PseudoTerminal&) = delete;
  PseudoTerminal& operator=(const PseudoTerminal&) = delete;
  ~PseudoTerminal() { close(end_); }

  std::string Device() const { return ptsname(end_); }

 private:
  int end_;
};

/// A real bridge process, autopilots by node-mavlink, and a subscriber on the bus.
class BridgeTest : public testing::Test {
 protected:
  void SetUp() override {
    if (const auto missing = MavlinkBoats::Missing()) GTEST_SKIP() << *missing;
  }

  std::vector<std::string> BridgeCommand(const std::string& address) const {
    return {TELLTALE_COMMAND, "bridge",        "--mavlink", address,
            "--vehicle-id",   "boat-{system}", "--domain",  std::to_string(domain_.id())};
  }
  std::vector<std::string> BridgeCommand() const {
    return BridgeCommand("udp:127.0.0.1:" + std::to_string(port_));
  }

  /// Two boats that send their data at ten times real time once all channels of both are connected;
  /// what they say they sent.
  nlohmann::json SendFrom(Process& boats) {
    receiver_.Of().clear();
    EXPECT_TRUE(boats.WaitForOutput("ready"));
    EXPECT_TRUE(HearBothBoats()) << "the boats are not heard";
    boats.Signal(SIGUSR2);
    EXPECT_TRUE(receiver_.ReceiveUntil([&] { return boats.WaitForOutput("]}]", 0s); }))
        << boats.output();
    const std::string output = boats.output();
    const auto sent =
        nlohmann::json::parse(output.substr(std::min(output.size(), output.find("[{"))));
    receiver_.ReceiveUntil([&] {
      return std::all_of(sent.begin(), sent.end(),
                         [&](const auto& boat) { return CountOf(boat) >= SizeOf(boat); });
    });
    return sent;
  }
  nlohmann::json SendFromTwoBoats(int seconds, int loss_every) {
    Process boats(MavlinkBoats::Command(std::to_string(port_), seconds, loss_every));
    return SendFrom(boats);
  }

  bool HearBothBoats() {
    return receiver_.ReceiveUntil([this] {
      return receiver_.Of().size() == 2 && std::ranges::all_of(receiver_.Of(), [](const auto& one) {
               return one.second.HasAll();
             });
    });
  }

  /// Compares sample by sample what arrived of each boat with what it says it sent from 10 s on.
  void ExpectAllReceived(const nlohmann::json& sent) {
    for (const auto& boat : sent) {
      const std::string id = "boat-" + std::to_string(boat["system"].get<int>());
      const ReceivedTelemetry got = FromTenSeconds(receiver_.Of()[id]);
      ASSERT_EQ(got.gnss.size(), boat["gnss"].size()) << id;
      ASSERT_EQ(got.heading.size(), boat["heading"].size()) << id;
      ASSERT_EQ(got.thrusters.size(), boat["thrusters"].size()) << id;
      // Times of 1.7e9 s are doubles 2.4e-7 s apart.
      const auto time_s = [](const nlohmann::json& row) {
        return kSenderBootS + row[0].get<double>() * 1e-3;
      };
      for (std::size_t i = 0; i < got.gnss.size(); ++i) {
        EXPECT_NEAR(got.gnss[i].time_s, time_s(boat["gnss"][i]), 1e-6);
        EXPECT_DOUBLE_EQ(got.gnss[i].latitude_deg, boat["gnss"][i][1].get<double>() * 1e-7);
        EXPECT_DOUBLE_EQ(got.gnss[i].longitude_deg, boat["gnss"][i][2].get<double>() * 1e-7);
      }
      for (std::size_t i = 0; i < got.heading.size(); ++i) {
        EXPECT_NEAR(got.heading[i].time_s, time_s(boat["heading"][i]), 1e-6);
        EXPECT_DOUBLE_EQ(got.heading[i].heading_deg,
                         boat["heading"][i][1].get<double>() * kDegreesPerRadian);
      }
      for (std::size_t i = 0; i < got.thrusters.size(); ++i) {
        EXPECT_NEAR(got.thrusters[i].time_s, time_s(boat["thrusters"][i]), 1e-6);
        EXPECT_EQ(got.thrusters[i].port_us, boat["thrusters"][i][1].get<double>());
        EXPECT_EQ(got.thrusters[i].starboard_us, boat["thrusters"][i][2].get<double>());
      }
    }
  }

  /// Column `lost frames` of a boat in what the bridge says at its end.
  static std::uint64_t LostFrames(const std::string& output, const std::string& id) {
    std::istringstream row(
        output.substr(std::min(output.size(), output.rfind('\n' + id + ' ') + 1)));
    std::string name;
    std::uint64_t system = 0, positions = 0, headings = 0, commands = 0, lost = 0;
    row >> name >> system >> positions >> headings >> commands >> lost;
    return lost;
  }

  LoopbackDomain domain_;
  int port_ = FreePort(SOCK_DGRAM);
  TelemetryReceiver receiver_{domain_.id()};

 private:
  static ReceivedTelemetry FromTenSeconds(const ReceivedTelemetry& all) {
    const auto later = [](const auto& samples) {
      auto kept = samples;
      std::erase_if(kept, [](const auto& sample) { return sample.time_s < kDataBeginS; });
      return kept;
    };
    return {later(all.gnss), later(all.heading), later(all.thrusters)};
  }

  /// How many samples from 10 s on have arrived of a boat.
  std::size_t CountOf(const nlohmann::json& boat) {
    const ReceivedTelemetry got =
        FromTenSeconds(receiver_.Of()["boat-" + std::to_string(boat["system"].get<int>())]);
    return got.gnss.size() + got.heading.size() + got.thrusters.size();
  }
  static std::size_t SizeOf(const nlohmann::json& boat) {
    return boat["gnss"].size() + boat["heading"].size() + boat["thrusters"].size();
  }
};

TEST_F(BridgeTest, PublishesWhatTwoBoatsSendAndCountsWhatIsLost) {
  Process bridge(BridgeCommand());
  ASSERT_TRUE(bridge.WaitForOutput("waiting for MAVLink")) << bridge.output();
  const auto sent = SendFromTwoBoats(20, 50);
  ExpectAllReceived(sent);
  for (const auto& boat : sent) {
    EXPECT_EQ(boat["asked"], nlohmann::json({2, 24, 30, 33, 36}));
  }
  // The autopilots start again: their clocks begin anew, at other ports.
  const auto again = SendFromTwoBoats(2, 0);
  ExpectAllReceived(again);
  EXPECT_TRUE(bridge.WaitForOutput("the autopilot of boat-2 has booted")) << bridge.output();

  bridge.Signal(SIGTERM);
  ASSERT_EQ(bridge.Wait(), 0) << bridge.output();
  for (const auto& boat : sent) {
    const std::string id = "boat-" + std::to_string(boat["system"].get<int>());
    EXPECT_GT(boat["lost"].get<std::uint64_t>(), 10u);
    EXPECT_EQ(LostFrames(bridge.output(), id), boat["lost"].get<std::uint64_t>())
        << bridge.output();
  }
  EXPECT_NE(bridge.output().find("bytes that are no MAVLink"), std::string::npos);
}

TEST_F(BridgeTest, SaysWhichAutopilotDeniesAnInterval) {
  Process bridge(BridgeCommand());
  ASSERT_TRUE(bridge.WaitForOutput("waiting for MAVLink")) << bridge.output();
  Process boats(MavlinkBoats::Command(std::to_string(port_), 1, 0, 36));
  ExpectAllReceived(SendFrom(boats));
  for (const std::string id : {"boat-1", "boat-2"}) {
    EXPECT_TRUE(bridge.WaitForOutput("the autopilot of " + id + " answers DENIED"))
        << bridge.output();
  }
  bridge.Signal(SIGTERM);
  ASSERT_EQ(bridge.Wait(), 0) << bridge.output();
  EXPECT_THAT(bridge.output(),
              testing::ContainsRegex("boat-1: [0-9]+ requests for message intervals denied"));
}

TEST_F(BridgeTest, TakesTwoBoatsOverTcpAndConnectsAgain) {
  const std::string port = std::to_string(FreePort(SOCK_STREAM));
  Process bridge(BridgeCommand("tcp:127.0.0.1:" + port));
  ASSERT_TRUE(bridge.WaitForOutput("cannot be reached")) << bridge.output();
  {
    Process boats(MavlinkBoats::Command("tcp:" + port, 5, 50));
    ASSERT_TRUE(bridge.WaitForOutput("is connected")) << bridge.output();
    const auto sent = SendFrom(boats);
    ExpectAllReceived(sent);
    for (const auto& boat : sent) EXPECT_EQ(boat["asked"], nlohmann::json({2, 24, 30, 33, 36}));
    EXPECT_EQ(boats.Wait(), 0);
  }
  ASSERT_TRUE(bridge.WaitForOutput("is lost")) << bridge.output();
  Process again(MavlinkBoats::Command("tcp:" + port, 1, 0));
  ExpectAllReceived(SendFrom(again));
  bridge.Signal(SIGTERM);
  ASSERT_EQ(bridge.Wait(), 0) << bridge.output();
}

TEST_F(BridgeTest, TakesTwoBoatsOverASerialLineAndOpensItAgain) {
  if (!std::filesystem::exists("/usr/bin/socat")) GTEST_SKIP() << "socat is not there";
  const TemporaryFolder folder;
  const std::string line = (folder.Path() / "line").string();
  const std::string port = std::to_string(FreePort(SOCK_STREAM));
  // A pseudo terminal whose other end is a connection to the boats.
  const auto lay_line = [&] {
    auto cable = std::make_unique<Process>(std::vector<std::string>{
        "/usr/bin/socat", "-d", "-d", "pty,raw,echo=0,link=" + line, "tcp:127.0.0.1:" + port});
    EXPECT_TRUE(cable->WaitForOutput("starting data transfer loop")) << cable->output();
    return cable;
  };
  Process boats(MavlinkBoats::Command("tcp:" + port, 1, 0));
  ASSERT_TRUE(boats.WaitForOutput("ready"));
  auto cable = lay_line();
  Process bridge(BridgeCommand("serial:" + line + ":57600"));
  ASSERT_TRUE(bridge.WaitForOutput("waiting for MAVLink")) << bridge.output();
  ASSERT_TRUE(HearBothBoats()) << bridge.output();
  for (const std::string system : {"1", "2"}) {
    EXPECT_TRUE(boats.WaitForOutput("system " + system + " is asked for 36")) << boats.output();
  }

  cable.reset();  // pulled
  ASSERT_TRUE(bridge.WaitForOutput("is lost")) << bridge.output();
  cable = lay_line();
  ASSERT_TRUE(bridge.WaitForOutput("is open again")) << bridge.output();
  const auto sent = SendFrom(boats);
  ExpectAllReceived(sent);
  for (const auto& boat : sent) EXPECT_EQ(boat["asked"], nlohmann::json({2, 24, 30, 33, 36}));
  bridge.Signal(SIGTERM);
  ASSERT_EQ(bridge.Wait(), 0) << bridge.output();
}

TEST_F(BridgeTest, TakesOneChannelAlone) {
  auto command = BridgeCommand();
  command.insert(command.end(), {"--channel", "thrusters"});
  Process bridge(command);
  ASSERT_TRUE(bridge.WaitForOutput("waiting for MAVLink")) << bridge.output();
  const Process boats(MavlinkBoats::Command(std::to_string(port_), 1, 0));
  ASSERT_TRUE(
      receiver_.ReceiveUntil([this] { return receiver_.Of()["boat-1"].thrusters.size() > 9; }));
  EXPECT_TRUE(receiver_.Of()["boat-1"].gnss.empty());
  EXPECT_TRUE(receiver_.Of()["boat-1"].heading.empty());
}

TEST_F(BridgeTest, RefusesAPortThatIsOccupied) {
  Process first(BridgeCommand());
  ASSERT_TRUE(first.WaitForOutput("waiting for MAVLink")) << first.output();
  Process second(BridgeCommand());
  EXPECT_EQ(second.Wait(), 1);
  EXPECT_NE(second.output().find("cannot be listened on"), std::string::npos) << second.output();
  first.Signal(SIGINT);
  EXPECT_EQ(first.Wait(), 0) << first.output();
}

TEST_F(BridgeTest, RefusesAddressesAndIdsThatAreWrong) {
  const auto run = [](std::vector<std::string> arguments, int code, const std::string& says) {
    arguments.insert(arguments.begin(), {TELLTALE_COMMAND, "bridge"});
    Process process(arguments);
    EXPECT_EQ(process.Wait(), code);
    EXPECT_NE(process.output().find(says), std::string::npos) << process.output();
  };
  run({"--mavlink", "udp:127.0.0.1:0"}, 2, "[1, 65535]");
  run({"--mavlink", "14550"}, 2, "must be udp:HOST:PORT");
  run({"--mavlink", "udp:127.0.0.1:14550", "--vehicle-id", "boat"}, 2, "{system}");
  run({"--mavlink", "udp:127.0.0.1:14550", "--vehicle-id", "a b {system}"}, 2, "must make 1..64");
  run({"--mavlink", "udp:127.0.0.1:14550", "--system-id", "256"}, 2, "256");
  run({"--mavlink", "udp:127.0.0.1:14550", "--channel", "attitude"}, 2, "heading");
  run({"--mavlink", "udp:127.0.0.1:14550", "--ros2"}, 2, "--ros2");
  run({"--ros2", "--namespace", "boats"}, 2, "each after a '/'");
  run({"--ros2", "--namespace", "/{vehicle}", "--vehicle-id", "boat"}, 2, "or neither");
  run({"--ros2", "--rate", "5"}, 2, "--mavlink");
  run({"--mavlink", "serial:/dev/no-such-line:57600"}, 1, "cannot be opened");
  run({"--mavlink", "serial:/dev/null:57600"}, 1, "it is no serial device");
  run({"--mavlink", "udp:127.0.0.1:14550", "--listen-only", "--rate", "5"}, 2, "--rate");
  run({"--ros2", "--port-channel", "1", "--starboard-channel", "1"}, 2,
      "output 1 stands for both thrusters");
  run({"--ros2", "--starboard-channel", "1"}, 2, "output 1 stands for both thrusters");
  const PseudoTerminal line;
  run({"--mavlink", "serial:" + line.Device() + ":1201"}, 1,
      "it has no rate of 1201 baud; 57600 and 115200 are usual");
}

}  // namespace
}  // namespace telltale
