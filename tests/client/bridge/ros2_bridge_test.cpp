#include <signal.h>

#include <cmath>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/loopback_domain.hpp"
#include "support/made_up_identifications.hpp"
#include "support/process.hpp"
#include "support/telemetry_receiver.hpp"
#include "telltale/client/bus/writer.hpp"
#include "telltale/core/base/degrees.hpp"
#include "telltale/idl/codec/json/published.hpp"
#include "telltale/idl/codec/wire/model.hpp"
#include "telltale/idl/codec/wire/quality.hpp"

namespace telltale {
namespace {

using testing::HasSubstr;

constexpr double kPeriodS = 0.05;  // of ros2_peer

/// A real bridge process, Fast DDS in the place of the nodes of ROS 2, and this process on the bus.
class Ros2BridgeTest : public testing::Test {
 protected:
  void SetUp() override {
#ifndef TELLTALE_ROS2_PEER
    GTEST_SKIP() << "Fast DDS is not there";
#endif
  }

  std::vector<std::string> Peer([[maybe_unused]] const std::string& does,
                                [[maybe_unused]] std::vector<std::string> names) const {
#ifdef TELLTALE_ROS2_PEER
    names.insert(names.begin(), {TELLTALE_ROS2_PEER, std::to_string(domain_.id()), does});
#endif
    return names;
  }
  std::vector<std::string> Bridge(std::vector<std::string> more = {}) const {
    more.insert(more.begin(),
                {TELLTALE_COMMAND, "bridge", "--ros2", "--domain", std::to_string(domain_.id())});
    return more;
  }

  const LoopbackDomain domain_{false};
};

/// What a boat of ros2_peer sends, sample by sample, from the first that is there on, none left
/// out.
void ExpectAsSent(const ReceivedTelemetry& got, double begin_s) {
  const auto time_s = [&](int i) { return begin_s + kPeriodS * i; };
  int i = static_cast<int>(std::lround((got.gnss.front().latitude_deg - 63.0) * 1e6));
  for (const GnssFix& fix : got.gnss) {
    if (i % 10 == 9) ++i;  // without a fix
    EXPECT_NEAR(fix.time_s, time_s(i), 1e-6);
    EXPECT_DOUBLE_EQ(fix.latitude_deg, 63.0 + 1e-6 * i);
    EXPECT_DOUBLE_EQ(fix.longitude_deg, 10.0 - 1e-6 * i);
    ++i;
  }
  i = static_cast<int>(std::lround((got.heading.front().time_s - begin_s) / kPeriodS));
  for (const HeadingSample& heading : got.heading) {
    EXPECT_NEAR(heading.time_s, time_s(i), 1e-6);
    const double expected_deg = 90.0 - 0.01 * i * kDegreesPerRadian;
    EXPECT_NEAR(std::remainder(heading.heading_deg - expected_deg, 360.0), 0.0, 1e-9);
    ++i;
  }
  i = static_cast<int>(std::lround((got.thrusters.front().time_s - begin_s) / kPeriodS));
  for (const ThrusterSample& commands : got.thrusters) {
    EXPECT_NEAR(commands.time_s, time_s(i), 1e-6);
    EXPECT_EQ(commands.port_us, 1100 + i % 800);
    EXPECT_EQ(commands.starboard_us, 1900 - i % 800);
    ++i;
  }
}

TEST_F(Ros2BridgeTest, PublishesWhatTwoBoatsOfAnotherDdsSay) {
  TelemetryReceiver receiver(domain_.id());
  Process bridge(Bridge({"--vehicle-id", "the-{vehicle}"}));
  ASSERT_TRUE(bridge.WaitForOutput("waiting for topics")) << bridge.output();
  Process boats(Peer("publish", {"boat1", "boat2"}));
  ASSERT_TRUE(boats.WaitForOutput("\n")) << boats.output();
  const double begin_s = 1e-9 * std::stod(boats.output());
  constexpr std::size_t kEnough = 50;
  ASSERT_TRUE(receiver.ReceiveUntil([&] {
    return receiver.Of()["the-boat1"].HasAll(kEnough) && receiver.Of()["the-boat2"].HasAll(kEnough);
  })) << bridge.output();
  boats.Signal(SIGTERM);
  EXPECT_EQ(boats.Wait(), 0);
  for (const auto& [id, got] : receiver.Of()) {
    SCOPED_TRACE(id);
    ExpectAsSent(got, begin_s);
  }
  bridge.Signal(SIGTERM);
  ASSERT_EQ(bridge.Wait(), 0) << bridge.output();
  EXPECT_THAT(bridge.output(), HasSubstr("the-boat1: headings from /boat1/mavros/imu/data"));
  EXPECT_THAT(bridge.output(), HasSubstr("messages without a fix"));
}

TEST_F(Ros2BridgeTest, TakesAMappingAndOneNamespaceAlone) {
  TelemetryReceiver receiver(domain_.id());
  Process bridge(Bridge({"--vehicle-id", "solo", "--namespace", "/boat2", "--map",
                         TELLTALE_SOURCE_DIR "/tests/fastdds/mapping.textproto"}));
  ASSERT_TRUE(bridge.WaitForOutput("waiting for topics")) << bridge.output();
  Process boats(Peer("publish", {"boat1", "boat2"}));
  ASSERT_TRUE(boats.WaitForOutput("\n")) << boats.output();
  const double begin_s = 1e-9 * std::stod(boats.output());
  ASSERT_TRUE(receiver.ReceiveUntil([&] { return receiver.Of()["solo"].HasAll(10); }))
      << bridge.output();
  EXPECT_EQ(receiver.Of().size(), 1u);
  for (const ThrusterSample& commands : receiver.Of()["solo"].thrusters) {
    const auto i = static_cast<int>(std::lround((commands.time_s - begin_s) / kPeriodS));
    EXPECT_EQ(commands.port_us, 1100 + i % 800);
    EXPECT_EQ(commands.starboard_us, 1900 - i % 800);
  }
}

TEST_F(Ros2BridgeTest, GivesModelsAndQualityToAnotherDds) {
  const Participant daemon(domain_.id());
  Writer<telltale_wire_Model> models(daemon);
  Writer<telltale_wire_Quality> qualities(daemon);
  PublishedModel model;
  model.identification = MadeUpIdentification();  // of made-up.1
  model.revision = 3;
  ASSERT_TRUE(models.Write(Encode(model)));
  Process bridge(Bridge());
  ASSERT_TRUE(bridge.WaitForOutput("models of made-up.1 go to /telltale/made_up_1/model"))
      << bridge.output();

  // It joins late, and is given the model all the same.
  Process peer(Peer("subscribe", {"/telltale/made_up_1/model"}));
  std::string json = PrintModelJson(model);
  std::erase(json, '\n');
  EXPECT_TRUE(peer.WaitForOutput("string /telltale/made_up_1/model " + json + '\n'))
      << peer.output();

  Quality quality;
  quality.vehicle_id = "made-up.1";
  quality.verdict = QualityVerdict::kError;
  quality.reasons = {{"CHANNEL_SILENT", QualityVerdict::kError, "no heading samples for 12 s"},
                     {"LOST", QualityVerdict::kWarn, "7 % of the samples are lost"}};
  ASSERT_TRUE(WaitForMatch(daemon, {qualities}, std::chrono::seconds(30)));
  Quality sound;
  sound.vehicle_id = "sound";
  sound.verdict = QualityVerdict::kOk;
  // Quality is best effort: it is said again, as the daemon does.
  const auto told = [&](const std::string& line) {
    for (int i = 0; i < 60; ++i) {
      qualities.Write(Encode(quality));
      qualities.Write(Encode(sound));
      if (peer.WaitForOutput(line, std::chrono::seconds(1))) return true;
    }
    return false;
  };
  EXPECT_TRUE(told("diagnostics 2 telltale: made-up.1: no heading samples for 12 s\n"))
      << peer.output();
  EXPECT_TRUE(told("diagnostics 0 telltale: sound: OK\n")) << peer.output();

  // Nothing more is heard of the daemon.
  EXPECT_TRUE(peer.WaitForOutput("diagnostics 3 telltale: sound: the daemon says nothing for"))
      << peer.output();
  peer.Signal(SIGTERM);
  EXPECT_EQ(peer.Wait(), 0);
}

}  // namespace
}  // namespace telltale
