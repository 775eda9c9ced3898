#include <arpa/inet.h>
#include <signal.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <map>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "support/loopback_domain.hpp"
#include "support/process.hpp"
#include "telltale/client/bus/participant.hpp"
#include "telltale/client/bus/reader.hpp"
#include "telltale/client/bus/wait_set.hpp"
#include "telltale/core/base/degrees.hpp"
#include "telltale/idl/codec/wire/telemetry.hpp"

namespace telltale {
namespace {

using namespace std::chrono_literals;
using SteadyClock = std::chrono::steady_clock;

constexpr double kSenderBootS = 1.7e9;  // of send_live.mjs
constexpr double kDataBeginS = kSenderBootS + 9.9995;
constexpr auto kPatience = 60s;

/// A UDP port of this machine that nobody listens on.
int FreePort() {
  const int socket_handle = socket(AF_INET, SOCK_DGRAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof(address);
  bind(socket_handle, reinterpret_cast<sockaddr*>(&address), size);
  getsockname(socket_handle, reinterpret_cast<sockaddr*>(&address), &size);
  close(socket_handle);
  return ntohs(address.sin_port);
}

/// What came over DDS of each vehicle.
struct Received {
  std::vector<GnssFix> gnss;
  std::vector<HeadingSample> heading;
  std::vector<ThrusterSample> thrusters;
};

/// A real bridge process, autopilots by node-mavlink, and a subscriber on the bus.
class BridgeTest : public testing::Test {
 protected:
  void SetUp() override {
    Process install({TELLTALE_SOURCE_DIR "/tests/deploy/from_npm", kSenderFolder, "send_live.mjs"});
    const auto code = install.Wait();
    if (code == 77) GTEST_SKIP() << install.output();
    ASSERT_EQ(code, 0) << install.output();
    wait_set_.Attach(gnss_,
                     [this] { gnss_.Take([this](const auto& w) { Keep(w, &Received::gnss); }); });
    wait_set_.Attach(heading_, [this] {
      heading_.Take([this](const auto& w) { Keep(w, &Received::heading); });
    });
    wait_set_.Attach(thrusters_, [this] {
      thrusters_.Take([this](const auto& w) { Keep(w, &Received::thrusters); });
    });
  }

  std::vector<std::string> BridgeCommand() const {
    return {
        TELLTALE_COMMAND, "bridge",        "--mavlink", "udp:127.0.0.1:" + std::to_string(port_),
        "--vehicle-id",   "boat-{system}", "--domain",  std::to_string(domain_.id())};
  }

  /// Autopilots of two boats that send `seconds` of data at ten times real time once all channels
  /// of both are connected; what they say they sent.
  nlohmann::json SendFromTwoBoats(int seconds, int loss_every) {
    received_.clear();
    Process sender({"/usr/bin/env", "node", std::string(kSenderFolder) + "/send_live.mjs",
                    std::to_string(port_), "2", std::to_string(seconds), std::to_string(loss_every),
                    "10"});
    EXPECT_TRUE(sender.WaitForOutput("ready"));
    EXPECT_TRUE(ReceiveUntil([this] {
      return received_.size() == 2 &&
             std::all_of(received_.begin(), received_.end(), [](const auto& one) {
               return !one.second.gnss.empty() && !one.second.heading.empty() &&
                      !one.second.thrusters.empty();
             });
    })) << "the boats are not heard";
    sender.Signal(SIGUSR2);
    EXPECT_TRUE(ReceiveUntil([&] { return sender.WaitForOutput("]}]", 0s); })) << sender.output();
    const std::string& output = sender.output();
    const auto sent =
        nlohmann::json::parse(output.substr(std::min(output.size(), output.find("[{"))));
    ReceiveUntil([&] {
      return std::all_of(sent.begin(), sent.end(),
                         [&](const auto& boat) { return Of(boat).size() >= SizeOf(boat); });
    });
    return sent;
  }

  /// Compares sample by sample what arrived of each boat with what it says it sent from 10 s on.
  void ExpectAllReceived(const nlohmann::json& sent) {
    for (const auto& boat : sent) {
      const std::string id = "boat-" + std::to_string(boat["system"].get<int>());
      const Received got = FromTenSeconds(received_[id]);
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
  int port_ = FreePort();

 private:
  static constexpr const char* kSenderFolder = TELLTALE_BINARY_DIR "/live_sender";

  template <class Wire, class Sample>
  void Keep(const Wire& wire, std::vector<Sample> Received::*channel) {
    const auto telemetry = Decode(wire);
    ASSERT_TRUE(telemetry);
    (received_[std::string(telemetry->vehicle_id)].*channel).push_back(telemetry->sample);
  }

  template <class Condition>
  bool ReceiveUntil(Condition condition) {
    const auto deadline = SteadyClock::now() + kPatience;
    while (!condition()) {
      if (SteadyClock::now() > deadline) return false;
      wait_set_.Wait(20ms);
    }
    return true;
  }

  static Received FromTenSeconds(const Received& all) {
    const auto later = [](const auto& samples) {
      auto kept = samples;
      std::erase_if(kept, [](const auto& sample) { return sample.time_s < kDataBeginS; });
      return kept;
    };
    return {later(all.gnss), later(all.heading), later(all.thrusters)};
  }

  /// All samples from 10 s on that have arrived of a boat.
  std::vector<double> Of(const nlohmann::json& boat) {
    const Received got =
        FromTenSeconds(received_["boat-" + std::to_string(boat["system"].get<int>())]);
    return std::vector<double>(got.gnss.size() + got.heading.size() + got.thrusters.size());
  }
  static std::size_t SizeOf(const nlohmann::json& boat) {
    return boat["gnss"].size() + boat["heading"].size() + boat["thrusters"].size();
  }

  Participant participant_{domain_.id()};
  WaitSet wait_set_{participant_};
  Reader<telltale_wire_GnssFix> gnss_{participant_};
  Reader<telltale_wire_Heading> heading_{participant_};
  Reader<telltale_wire_Thrusters> thrusters_{participant_};
  std::map<std::string, Received> received_;
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
  run({"--mavlink", "serial:/dev/no-such-line:57600"}, 1, "cannot be opened");
}

}  // namespace
}  // namespace telltale
