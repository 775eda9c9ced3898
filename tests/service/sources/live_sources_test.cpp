#include <signal.h>

#include <algorithm>
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "service/service_fixture.hpp"
#include "support/mavlink_boats.hpp"
#include "support/process.hpp"
#include "support/telemetry_receiver.hpp"

namespace telltale {
namespace {

std::string Boat(const std::string& id) {
  return "vehicles { vehicle_id: \"" + id +
         "\" propeller_separation_m: 0.6 port { neutral_us: 1500 full_forward_us: 1900 "
         "full_reverse_us: 1100 } "
         "starboard { neutral_us: 1500 full_forward_us: 1900 full_reverse_us: 1100 } }\n";
}

bool HearsAllChannels(const Quality& quality) {
  return quality.gnss_rate_hz > 0.0 && quality.heading_rate_hz > 0.0 &&
         quality.thrusters_rate_hz > 0.0;
}

const QualityReason* ReasonOf(const Quality& quality, const std::string& code) {
  const auto found = std::ranges::find(quality.reasons, code, &QualityReason::code);
  return found == quality.reasons.end() ? nullptr : &*found;
}

/// The daemon takes boats by itself, without another program.
class LiveSourcesTest : public ServiceTest {};

TEST_F(LiveSourcesTest, MavlinkIsTakenAndWhatFailsIsSaidAndTriedAgain) {
  if (const auto missing = MavlinkBoats::Missing()) GTEST_SKIP() << *missing;
  const std::string port = std::to_string(FreePort(SOCK_STREAM));
  Configure(Boat("boat-1") + Boat("boat-2") +
            "sources { vehicle_id: \"boat-{system}\" mavlink { address: \"tcp:127.0.0.1:" + port +
            "\" } }\n"
            "sources { mavlink { address: \"serial:/dev/no-such-line:57600\" } }\n");
  const auto daemon = StartDaemon(3);
  EXPECT_TRUE(daemon->WaitForOutput("serial:/dev/no-such-line:57600 cannot be opened"))
      << daemon->output();
  const auto failing = AwaitQuality("boat-1", [&](const Quality& quality) {
    return std::ranges::any_of(quality.reasons, [&](const QualityReason& reason) {
      return reason.code == "SOURCE_FAILED" && reason.text.find(port) != std::string::npos;
    });
  });
  ASSERT_TRUE(failing) << daemon->output();
  EXPECT_EQ(failing->verdict, QualityVerdict::kStale);

  Process boats(MavlinkBoats::Command("tcp:" + port, 1, 0));
  for (const std::string id : {"boat-1", "boat-2"}) {
    const auto heard = AwaitQuality(id, [](const Quality& quality) {
      return HearsAllChannels(quality) && ReasonOf(quality, "SOURCE_FAILED") == nullptr;
    });
    ASSERT_TRUE(heard) << id << daemon->output();
  }
  // The boat that no source brings still says which of them fails.
  const auto other = AwaitQuality(kVehicleId, [](const Quality& quality) {
    return ReasonOf(quality, "SOURCE_FAILED") != nullptr;
  });
  ASSERT_TRUE(other);
  EXPECT_NE(ReasonOf(*other, "SOURCE_FAILED")->text.find("no-such-line"), std::string::npos);
  daemon->Signal(SIGTERM);
  EXPECT_EQ(daemon->Wait(), 0) << daemon->output();
}

TEST_F(LiveSourcesTest, WrongSourcesAreRefusedByField) {
  const auto refused = [&](const std::string& sources, const std::string& says) {
    const std::string file = folder_.Write(
        "wrong.textproto",
        "state_directory: \"" + (folder_.Path() / "wrong").string() + "\"\n" + sources);
    Process daemon({TELLTALED, "--config", file});
    EXPECT_EQ(daemon.Wait(), 2) << sources;
    EXPECT_NE(daemon.output().find(says), std::string::npos) << daemon.output();
  };
  refused("sources { mavlink { address: \"14550\" } }", "sources[0].mavlink.address");
  refused("sources { mavlink { address: \"udp:127.0.0.1:1\" } vehicle_id: \"boat\" }",
          "sources[0].vehicle_id");
  refused("sources { mavlink { address: \"udp:127.0.0.1:1\" system_ids: 256 } }", "[1, 255]");
  refused("sources { ros2 { namespace: \"boats\" } }", "sources[0].ros2");
  refused("sources { ros2 { mapping_file: \"none.textproto\" } }", "sources[0].ros2.mapping_file");
  refused("sources { ros2 {} port_channel: 17 }", "[1, 16]");
  refused("sources { ros2 {} channels: \"attitude\" }", "gnss, heading, thrusters");
  refused("sources { }", "one of the two");
  refused("sources { ros2 {} mavlink { address: \"udp:127.0.0.1:1\" } }", "one of the two");
}

class LiveRos2SourceTest : public ServiceTest {
 protected:
  LiveRos2SourceTest() : ServiceTest(Engine::kSqlite, false) {}
};

TEST_F(LiveRos2SourceTest, TopicsBecomeTelemetryAndQualityGoesBack) {
#ifdef TELLTALE_ROS2_PEER
  Configure(Boat("boat1") + "sources { ros2 { namespace: \"/{vehicle}\" } }\n");
  const auto daemon = StartDaemon(2);
  const std::string domain = std::to_string(domain_.id());
  Process boats({TELLTALE_ROS2_PEER, domain, "publish", "boat1"});
  Process monitor({TELLTALE_ROS2_PEER, domain, "subscribe"});
  ASSERT_TRUE(AwaitQuality("boat1", HearsAllChannels)) << daemon->output();
  EXPECT_TRUE(monitor.WaitForOutput("diagnostics 1 telltale: boat1: there is no model"))
      << monitor.output();
  EXPECT_TRUE(monitor.WaitForOutput("diagnostics 3 telltale: yellowfish: no telemetry"))
      << monitor.output();
  daemon->Signal(SIGTERM);
  EXPECT_EQ(daemon->Wait(), 0) << daemon->output();
#else
  GTEST_SKIP() << "Fast DDS is not there";
#endif
}

// ArduPilot's own topics hold no outputs, so they come by MAVLink: docs/guides/live-ros2.md.
TEST_F(LiveRos2SourceTest, PositionsOfArduPilotsTopicsJoinItsOutputsByMavlink) {
#ifdef TELLTALE_ROS2_PEER
  if (const auto missing = MavlinkBoats::Missing()) GTEST_SKIP() << *missing;
  const std::string port = std::to_string(FreePort(SOCK_STREAM));
  Configure(Boat("boat-1") +
            "sources { vehicle_id: \"boat-1\" channels: \"gnss\" channels: \"heading\" ros2 { "
            "namespace: \"/ap\" mapping_file: \"" TELLTALE_SOURCE_DIR
            "/deploy/mappings/ardupilot.textproto\" } }\n"
            "sources { vehicle_id: \"boat-1\" channels: \"thrusters\" mavlink { address: "
            "\"tcp:127.0.0.1:" +
            port + "\" system_ids: 1 } }\n");
  TelemetryReceiver receiver(domain_.id());
  const auto daemon = StartDaemon(2);
  Process positions({TELLTALE_ROS2_PEER, std::to_string(domain_.id()), "ardupilot"});
  Process outputs(MavlinkBoats::Command("tcp:" + port, 1, 0));
  ASSERT_TRUE(AwaitQuality("boat-1", HearsAllChannels)) << daemon->output();

  ASSERT_TRUE(receiver.ReceiveUntil([&] { return receiver.Of()["boat-1"].HasAll(20); }));
  EXPECT_EQ(receiver.Of().size(), 1u);
  const ReceivedTelemetry& got = receiver.Of()["boat-1"];
  for (const GnssFix& fix : got.gnss) {  // those of MAVLink lie 40 km further north
    const double i = (fix.latitude_deg - 63.0) * 1e6;
    EXPECT_NEAR(i, std::round(i), 1e-3);
    EXPECT_NEAR(fix.longitude_deg, 10.0 - 1e-6 * i, 1e-9);
  }
  for (const ThrusterSample& commands : got.thrusters) EXPECT_EQ(commands.port_us, 1500.0);
#else
  GTEST_SKIP() << "Fast DDS is not there";
#endif
}

}  // namespace
}  // namespace telltale
