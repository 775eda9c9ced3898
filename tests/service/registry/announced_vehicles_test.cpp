#include <signal.h>

#include <chrono>
#include <cstring>
#include <memory>
#include <string>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "service/registry/made_up_boat.hpp"
#include "service/service_fixture.hpp"
#include "service/shared_fleet_fixture.hpp"
#include "service/standby/daemon_pair.hpp"
#include "support/mavlink_boats.hpp"
#include "telltale/client/bus/writer.hpp"
#include "telltale/client/fleet/served_vehicles.hpp"
#include "telltale/client/fleet/vehicle_announcer.hpp"
#include "telltale/client/recording/telemetry_log/telemetry_log.hpp"
#include "telltale/idl/codec/vehicle_file.hpp"
#include "telltale/idl/codec/wire/vehicle_announcement.hpp"
#include "telltale/service/registry/vehicle_store.hpp"

namespace telltale {
namespace {

using namespace std::chrono_literals;
using testing::Boat;
using ::testing::HasSubstr;
using ::testing::Not;

/// A daemon whose configuration names no boat, unless a test adds some.
class AnnouncedVehicles : public ServiceTest, public ::testing::WithParamInterface<Engine> {
 protected:
  AnnouncedVehicles() : ServiceTest(GetParam()) {
    ConfigureIdentification("bootstrap_replicates: 0 structure: \"static\"", {});
  }

  void Admit(const std::string& pattern) const {
    Configure("announced { admit: \"" + pattern + "\" }\n");
  }

  /// A replay of the simulated boat, which announces itself.
  std::unique_ptr<Process> ReplayAnnounced(const std::string& timeout_s = "60") const {
    WriteTelemetryLog(folder_.Path() / "log", SimulatedRecording());
    return Start({"replay", "--log", folder_.Path() / "log", "--announce",
                  folder_.Path() / "vehicle.textproto", "--speed", "60", "--timeout", timeout_s});
  }

  bool IsServed(const std::string& vehicle_id) const {
    return AwaitServed(Participant(domain_.id()), {vehicle_id}, 60s).empty();
  }

  /// Whether so many announcements are refused for this reason, or will be within a minute.
  bool AwaitRefused(const std::string& reason, std::uint64_t count = 1) const {
    return AwaitQuality(
               std::string(kUnattributed),
               [&](const Quality& quality) { return CountOf(quality, "vehicle", reason) == count; })
        .has_value();
  }
};

INSTANTIATE_TEST_SUITE_P(Engines, AnnouncedVehicles, kEngines, EngineName);

TEST_P(AnnouncedVehicles, AreIdentifiedAndServedAfterARestart) {
  Admit("yellow*");
  {
    const auto daemon = StartDaemon(0);
    const auto replay = ReplayAnnounced();
    EXPECT_EQ(replay->Wait(), 0) << replay->output();
    EXPECT_THAT(replay->output(), HasSubstr("all received"));
    Run({"identify", "--vehicle-id", kVehicleId});
    ASSERT_TRUE(AwaitSavedWindow());
  }
  // The boat is gone, and the daemon was killed.
  const auto daemon = StartDaemon(1);
  const auto list = Start({"list"});
  EXPECT_EQ(list->Wait(), 0);
  EXPECT_THAT(list->output(), HasSubstr(kVehicleId));
  Run({"identify", "--vehicle-id", kVehicleId});
}

TEST_P(AnnouncedVehicles, AreNotServedWhereNoPatternHasTheirId) {
  Admit("blue*");
  const auto daemon = StartDaemon(0);
  const auto replay = ReplayAnnounced("3");
  EXPECT_EQ(replay->Wait(), 1);
  EXPECT_THAT(replay->output(), HasSubstr("serves yellowfish within 3 s"));
  EXPECT_THAT(replay->output(), HasSubstr("announced { admit"));
  EXPECT_TRUE(AwaitRefused("NOT_ADMITTED"));
  EXPECT_THAT(daemon->output(), HasSubstr("announcement refused: NOT_ADMITTED 'yellowfish'"));
}

TEST_P(AnnouncedVehicles, AreHeardByADaemonThatStartsLater) {
  Admit("*");
  const Participant participant(domain_.id());
  VehicleAnnouncer announcer(participant, "boat-7");
  announcer.Announce(Boat("boat-7"));
  const auto daemon = StartDaemon(0);
  EXPECT_TRUE(daemon->WaitForOutput("admitted: boat-7")) << daemon->output();
  EXPECT_TRUE(IsServed("boat-7"));
}

TEST_P(AnnouncedVehicles, MayAnnounceOtherParticularsAndKeepTheirSamples) {
  Admit("yellow*");
  {
    const auto daemon = StartDaemon(0);
    EXPECT_EQ(ReplayAnnounced()->Wait(), 0);
    const Participant participant(domain_.id());
    VehicleAnnouncer announcer(participant, kVehicleId);
    ASSERT_TRUE(announcer.WaitForReaders(60s));
    announcer.Announce(Boat(kVehicleId, 31.0));
    EXPECT_TRUE(daemon->WaitForOutput("0 added, 1 changed")) << daemon->output();
    EXPECT_TRUE(AwaitQuality(kVehicleId, [](const Quality& quality) {
      return quality.window_s > 100.0;
    })) << "its window of two minutes is gone";
  }
  const auto stored = VehicleStore(Storage()).All();
  ASSERT_EQ(stored.size(), 1u);
  EXPECT_EQ(stored.front().mass_kg, 31.0);
}

TEST_P(AnnouncedVehicles, LeaveTheFleetOnceTheyAreRetired) {
  Admit("boat-*");
  {
    const auto daemon = StartDaemon(0);
    {
      const Participant participant(domain_.id());
      VehicleAnnouncer one(participant, "boat-1");
      VehicleAnnouncer two(participant, "boat-2");
      one.Announce(Boat("boat-1"));
      two.Announce(Boat("boat-2"));
      EXPECT_TRUE(IsServed("boat-1") && IsServed("boat-2"));
      two.Retire();
      EXPECT_TRUE(daemon->WaitForOutput("retired: boat-2")) << daemon->output();
    }
    // Nobody writes of boat-1 any more, which retires nothing.
    EXPECT_TRUE(IsServed("boat-1"));
    Run({"retire", "--vehicle-id", "boat-1"});
    EXPECT_TRUE(daemon->WaitForOutput("serving 0 vehicles: 0 added, 0 changed, 1 no longer"))
        << daemon->output();
    const auto again = Start({"retire", "--vehicle-id", "boat-1"});
    EXPECT_EQ(again->Wait(), 1);
    EXPECT_THAT(again->output(), HasSubstr("no daemon serves boat-1"));
  }
  EXPECT_NE(StartDaemon(0), nullptr);
}

TEST_P(AnnouncedVehicles, YieldToTheConfigurationWhichSaysSoOnce) {
  ConfigureIdentification("bootstrap_replicates: 0", {"vehicle.textproto"});
  Admit("*");
  const auto daemon = StartDaemon(1);
  const Participant participant(domain_.id());
  VehicleAnnouncer announcer(participant, kVehicleId);
  announcer.Announce(Boat(kVehicleId, 31.0));
  const std::string told = std::string(kVehicleId) + " announces itself; what the configuration";
  EXPECT_TRUE(daemon->WaitForOutput(told)) << daemon->output();
  announcer.Announce(Boat(kVehicleId, 32.0));
  VehicleAnnouncer later(participant, "boat-7");
  later.Announce(Boat("boat-7"));
  EXPECT_TRUE(daemon->WaitForOutput("admitted: boat-7")) << daemon->output();
  EXPECT_EQ(daemon->output().find(told), daemon->output().rfind(told)) << daemon->output();
  EXPECT_TRUE(daemon->WaitForOutput("serving 2 vehicles: 1 added, 0 changed")) << daemon->output();
  const auto retired = Start({"retire", "--vehicle-id", kVehicleId, "--timeout", "2"});
  EXPECT_EQ(retired->Wait(), 1);
  EXPECT_THAT(retired->output(), HasSubstr("still served: the configuration"));
}

TEST_P(AnnouncedVehicles, ComeFromTheirOwnPartitionWhereThatIsRequired) {
  Configure("require_partition: true\n");
  Admit("boat-*");
  const auto daemon = StartDaemon(0);
  const Participant participant(domain_.id());
  VehicleAnnouncer own(participant, "boat-1");
  own.Announce(Boat("boat-1"));
  EXPECT_TRUE(IsServed("boat-1"));
  Writer<telltale_wire_VehicleAnnouncement> other(participant,
                                                  InPartitions(VehicleQos(), {"", "boat-2"}));
  ASSERT_TRUE(WaitForMatch(participant, {other}, 60s));
  other.Write(Encode(Boat("boat-3")));
  EXPECT_TRUE(AwaitRefused("FOREIGN_WRITER", 1));
  other.Dispose(EncodeRetired("boat-1"));
  EXPECT_TRUE(AwaitRefused("FOREIGN_WRITER", 2));
  EXPECT_TRUE(IsServed("boat-1"));
}

TEST_P(AnnouncedVehicles, AreHeardAgainWhenTheConfigurationIsReadAgain) {
  const auto daemon = StartDaemon(0);
  const Participant participant(domain_.id());
  VehicleAnnouncer announcer(participant, "boat-7");
  announcer.Announce(Boat("boat-7"));
  EXPECT_TRUE(AwaitRefused("NOT_ADMITTED"));
  Admit("boat-*");
  daemon->Signal(SIGHUP);
  EXPECT_TRUE(daemon->WaitForOutput("admitted: boat-7")) << daemon->output();
  EXPECT_TRUE(IsServed("boat-7"));
}

/// A daemon that admits boats, and a writer that it hears and that may write anything.
class AnnouncementsByAnybody : public AnnouncedVehicles {
 protected:
  void SetUp() override {
    Admit("boat-*");
    daemon_ = StartDaemon(0);
    ASSERT_TRUE(WaitForMatch(participant_, {writer_}, 60s));
  }

  std::unique_ptr<Process> daemon_;
  Participant participant_{domain_.id()};
  Writer<telltale_wire_VehicleAnnouncement> writer_{participant_};
};

INSTANTIATE_TEST_SUITE_P(Engines, AnnouncementsByAnybody, kEngines, EngineName);

TEST_P(AnnouncementsByAnybody, AreCountedByReasonWhereTheyAreNone) {
  const auto write = [&](const std::string& key, const std::string& text) {
    auto wire = EncodeRetired("x");
    std::strcpy(wire->vehicle_id, key.c_str());
    dds_string_free(wire->vehicle_file);
    wire->vehicle_file = dds_string_dup(text.c_str());
    EXPECT_TRUE(writer_.Write(wire));
  };
  const std::string file = PrintVehicle(Boat("boat-1"));
  write("two words", file);
  write("boat-2", file);
  write("boat-3", file + std::string(20'000'000, ' '));
  write("boat-4", "\x1b[2J" + file);
  write("boat-5", "vehicle_id: \"boat-5\" port {");
  write("boat-6", PrintVehicle(Boat("boat-6", -3.0)));
  EXPECT_TRUE(AwaitRefused("MALFORMED_VEHICLE_ID"));
  EXPECT_TRUE(AwaitRefused("OTHER_VEHICLE_ID"));
  EXPECT_TRUE(AwaitRefused("TOO_LARGE"));
  EXPECT_TRUE(AwaitRefused("NOT_TEXT"));
  EXPECT_TRUE(AwaitRefused("NOT_A_VEHICLE_FILE", 2));
  for (int i = 0; i < 2000; ++i) write("boat-5", "broken " + std::to_string(i));
  // Of one boat the last alone is kept until it is taken.
  VehicleAnnouncer honest(participant_, "boat-1");
  honest.Announce(Boat("boat-1"));
  EXPECT_TRUE(IsServed("boat-1"));
  const std::string log = daemon_->output();
  EXPECT_THAT(log, Not(HasSubstr("\x1b[2J")));
  EXPECT_LT(log.size(), 20'000u) << "its lines have a limit";
  EXPECT_THAT(log, Not(HasSubstr("serving 2 vehicles")));
}

// Each id takes memory of the daemon, and anybody can invent some.
TEST_P(AnnouncementsByAnybody, AreNotHeardBeyondAsManyIdsAsADaemonHolds) {
  VehicleAnnouncer known(participant_, "boat-1");
  known.Announce(Boat("boat-1"));
  ASSERT_TRUE(IsServed("boat-1"));
  for (int i = 0; i < kMostBoats + 4; ++i)
    writer_.Write(Encode(Boat("invented-" + std::to_string(i))));
  EXPECT_TRUE(AwaitRefused("TOO_MANY_IDS", 5));
  known.Announce(Boat("boat-1", 31.0));
  EXPECT_TRUE(daemon_->WaitForOutput("0 added, 1 changed")) << daemon_->output();
}

TEST_P(AnnouncementsByAnybody, AreHeardWhileIdsThatNobodyKnowsAreRetired) {
  for (int i = 0; i < 2 * kMostBoats; ++i) {
    // The key alone, which the limit of ids does not count.
    Checked(dds_dispose(writer_.handle(), &*EncodeRetired("invented-" + std::to_string(i))), "");
  }
  VehicleAnnouncer honest(participant_, "boat-1");
  honest.Announce(Boat("boat-1"));
  EXPECT_TRUE(IsServed("boat-1")) << daemon_->output();
}

class AnnouncingCommands : public ServiceTest {};

TEST_F(AnnouncingCommands, LetTheBoatsOfALoadBeServed) {
  ConfigureIdentification("bootstrap_replicates: 0", {});
  Configure("announced { admit: \"load-*\" most: 20 }\n");
  const auto daemon = StartDaemon(0);
  const auto load = Start({"load", "--boats", "20", "--announce", "--duration", "1"});
  EXPECT_EQ(load->Wait(), 0) << load->output();
  const auto beyond =
      Start({"load", "--boats", "22", "--announce", "--duration", "1", "--timeout", "3"});
  EXPECT_EQ(beyond->Wait(), 1);
  EXPECT_THAT(beyond->output(), HasSubstr("serves load-00021 and 1 other vehicle within 3 s"));
  EXPECT_THAT(daemon->output(), HasSubstr("BEYOND_LIMIT 'load-00021'"));
}

TEST_F(AnnouncingCommands, LetTheBoatsOfABridgeBeServedBeforeTheyAreHeard) {
  ConfigureIdentification("bootstrap_replicates: 0", {});
  Configure("announced { admit: \"*\" }\n");
  folder_.Write("mavlink-1.textproto", PrintVehicle(Boat("mavlink-1")));
  folder_.Write("mavlink-2.textproto", PrintVehicle(Boat("mavlink-2")));
  const auto daemon = StartDaemon(0);
  for (const std::vector<std::string>& source :
       {std::vector<std::string>{"--mavlink",
                                 "udp:127.0.0.1:" + std::to_string(FreePort(SOCK_DGRAM))},
        {"--ros2"}}) {
    const std::string number = source.size() == 2 ? "1" : "2";
    std::vector<std::string> command{"bridge"};
    command.insert(command.end(), source.begin(), source.end());
    command.insert(command.end(),
                   {"--announce", folder_.Path() / ("mavlink-" + number + ".textproto")});
    const auto bridge = Start(command);
    EXPECT_TRUE(AwaitServed(Participant(domain_.id()), {"mavlink-" + number}, 60s).empty())
        << bridge->output();
    bridge->Signal(SIGTERM);
    EXPECT_EQ(bridge->Wait(), 0) << bridge->output();
  }
}

TEST_F(AnnouncingCommands, RefuseAFileOfAnotherBoat) {
  WriteTelemetryLog(folder_.Path() / "log", SimulatedRecording());
  const auto replay = Start({"replay", "--log", folder_.Path() / "log", "--vehicle-id", "another",
                             "--announce", folder_.Path() / "vehicle.textproto"});
  EXPECT_EQ(replay->Wait(), 2);
  EXPECT_THAT(replay->output(), HasSubstr("is of yellowfish, and --vehicle-id is another"));
}

class AnnouncedToAPair : public ServiceTest {
 protected:
  DaemonPair pair_{domain_.id(), folder_, 5.0, "announced { admit: \"boat-*\" }\n"};
};

// Each hears them and stores them for itself; by then they are silent.
TEST_F(AnnouncedToAPair, AreServedByTheStandbyOnceItTakesOver) {
  const auto one = pair_.Start("one", 2);
  ASSERT_TRUE(DaemonPair::TakesOver(*one, 1)) << one->output();
  const auto two = pair_.Start("two", 1);
  ASSERT_TRUE(DaemonPair::StandsBy(*two, 1)) << two->output();
  {
    const Participant participant(domain_.id());
    VehicleAnnouncer announcer(participant, "boat-7");
    announcer.Announce(Boat("boat-7"));
    EXPECT_TRUE(AwaitServed(participant, {"boat-7"}, 60s).empty());
    ASSERT_TRUE(two->WaitForOutput("admitted: boat-7")) << two->output();
  }
  one->Signal(SIGKILL);
  one->Wait();
  ASSERT_TRUE(DaemonPair::TakesOver(*two, 2)) << two->output();
  EXPECT_TRUE(AwaitServed(Participant(domain_.id()), {"boat-7", "yellowfish"}, 60s).empty());
  EXPECT_EQ(VehicleStore(telltale::Storage(folder_.Path() / "state-two")).All().size(), 1u);
}

class SharedAnnouncedVehicles : public SharedFleetTest {
 protected:
  // Slices 17, 43, 61 and 30 for boat-1 to boat-4; the first alone has a file.
  SharedAnnouncedVehicles() : SharedFleetTest(1) {}

  std::unique_ptr<Process> StartAnnounced(const std::string& name) const {
    const std::string config = ConfigOf(name, "slices { lease_s: " + std::to_string(kLeaseS) +
                                                  " }\nannounced { admit: \"boat-*\" }\n");
    return std::make_unique<Process>(std::vector<std::string>{TELLTALED, "--config", config});
  }
};

TEST_F(SharedAnnouncedVehicles, AreServedByOneDaemonAndAfterItsDeathByTheOther) {
  const auto one = StartAnnounced("one");
  ASSERT_TRUE(one->WaitForOutput("serving 1 vehicles:")) << one->output();
  auto two = StartAnnounced("two");
  ASSERT_TRUE(two->WaitForOutput("holds 32 of 64 slices")) << two->output();
  {
    const Participant participant(domain_.id());
    std::vector<VehicleAnnouncer> announcers;
    for (const std::string id : {"boat-2", "boat-3", "boat-4"}) {
      announcers.emplace_back(participant, id).Announce(Boat(id));
    }
    EXPECT_TRUE(AwaitServed(participant, {"boat-1", "boat-2", "boat-3", "boat-4"}, 60s).empty());
  }
  EXPECT_TRUE(one->WaitForOutput("serving 2 vehicles:")) << one->output();
  EXPECT_TRUE(two->WaitForOutput("serving 2 vehicles:")) << two->output();
  two->Signal(SIGKILL);
  EXPECT_TRUE(one->WaitForOutput("serving 4 vehicles:")) << one->output();
  // One that comes later and has heard none of them shares them.
  two = StartAnnounced("two");
  EXPECT_TRUE(two->WaitForOutput("serving 2 vehicles:")) << two->output();
  EXPECT_EQ(VehicleStore(Storage()).All().size(), 3u);
}

}  // namespace
}  // namespace telltale
