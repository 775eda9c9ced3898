#include <signal.h>

#include <bit>
#include <chrono>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <google/protobuf/util/json_util.h>
#include <gtest/gtest.h>

#include "service/shared_fleet_fixture.hpp"
#include "support/notify_socket.hpp"
#include "support/page_of.hpp"
#include "support/stable_boat.hpp"
#include "telltale/client/fleet/fleet_client.hpp"
#include "telltale/client/fleet/identification_client.hpp"
#include "telltale/client/recording/telemetry_log/telemetry_log.hpp"
#include "telltale/idl/proto/fleet.pb.h"
#include "telltale/service/models/model_store.hpp"
#include "telltale/service/web/httplib.hpp"

namespace telltale {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;
using ::testing::Not;

class SharedFleet : public SharedFleetTest {
 protected:
  // Slices 17, 43, 61 and 30: two for the daemon that comes first, which keeps the lower ones.
  SharedFleet() : SharedFleetTest(4) {}

  /// Starts two daemons, and waits until each has its half of the slices.
  void StartBoth() {
    one_ = StartNamed("one");
    ASSERT_TRUE(one_->WaitForOutput("serving 4 vehicles:")) << one_->output();
    two_ = StartNamed("two");
    ASSERT_TRUE(two_->WaitForOutput("holds 32 of 64 slices")) << two_->output();
    ASSERT_TRUE(two_->WaitForOutput("serving 2 vehicles:")) << two_->output();
  }

  void ReplayTo(const std::string& boat, const Recording& recording) const {
    const auto log = folder_.Path() / ("log-" + boat);
    WriteTelemetryLog(log, recording);
    Run({"replay", "--log", log, "--vehicle-id", boat, "--speed", "60"});
  }

  /// No model was written under a lease that is older than that of the model before.
  void ExpectModelsInTheOrderOfTheirLeases() const {
    std::map<std::string, std::int64_t> newest;
    Storage()
        .Open(ModelsSchema())
        ->Query("SELECT vehicle_id, fence FROM models ORDER BY vehicle_id, revision", {},
                [&](const Row& row) {
                  std::int64_t& before = newest[row.Text("vehicle_id")];
                  EXPECT_GE(row.Integer("fence"), before) << row.Text("vehicle_id");
                  before = row.Integer("fence");
                });
    EXPECT_FALSE(newest.empty());
  }

  std::unique_ptr<Process> one_;
  std::unique_ptr<Process> two_;
};

TEST_F(SharedFleet, IsServedByTheOtherWhenADaemonIsKilled) {
  ASSERT_NO_FATAL_FAILURE(StartBoth());
  const Recording recording = SimulatedRecording(testing::StableBoat(), 0.0, 300.0, 4);
  for (const std::string& boat : boats_) {
    ReplayTo(boat, recording);
    EXPECT_EQ(Start({"identify", "--vehicle-id", boat})->Wait(), 0) << boat;
  }
  ASSERT_TRUE(AwaitSavedWindow("boat-2"));
  ASSERT_TRUE(AwaitSavedWindow("boat-3"));

  two_->Signal(SIGKILL);
  two_->Wait();
  ASSERT_TRUE(one_->WaitForOutput("holds 64 of 64 slices, 32 of them newly"));
  for (const std::string& boat : boats_) {
    EXPECT_EQ(Start({"identify", "--vehicle-id", boat})->Wait(), 0) << boat;
    EXPECT_EQ(ModelStore(Storage()).History(boat).size(), 2u) << boat;
  }
  EXPECT_THAT(one_->output(), Not(HasSubstr("UNKNOWN_VEHICLE")));
  EXPECT_EQ(OverlappingLeases(), 0);
  ExpectModelsInTheOrderOfTheirLeases();
}

TEST_F(SharedFleet, IsServedByADaemonThatSaysThatItIsReady) {
  NotifySocket manager(folder_.Path() / "notify", 10s);
  one_ = StartNamed("one");
  std::string before;
  ASSERT_TRUE(manager.Await("READY=1", &before)) << one_->output();
  EXPECT_THAT(before, HasSubstr("STATUS=starting with"));
  EXPECT_THAT(before, Not(HasSubstr("STATUS=serving")));
  EXPECT_TRUE(manager.Await("STATUS=serving 4 vehicles"));
}

// The client is told that the request is queued, and the daemon that told it is gone.
TEST_F(SharedFleet, GetsTheAnswerThatADeadDaemonOwed) {
  ASSERT_NO_FATAL_FAILURE(StartBoth());
  ReplayTo("boat-2", SimulatedRecording(testing::StableBoat(), 0.0, 90.0, 4));
  ASSERT_TRUE(AwaitSavedWindow("boat-2"));
  const Participant participant(domain_.id());
  IdentificationClient client(participant);
  IdentifyRequest request = Request("owed");
  request.vehicle_id = "boat-2";
  request.structure = Structure::kFossen;  // a second of work
  const auto result = client.Identify(request, {.match = 60s, .reply = 240s, .retry = 1s},
                                      [&](const IdentifyProgress&) { two_->Signal(SIGKILL); });
  EXPECT_EQ(result.outcome, RequestOutcome::kPublished);
  EXPECT_TRUE(one_->WaitForOutput("requests of the daemons before"));
  EXPECT_TRUE(one_->WaitForOutput("for owed: PUBLISHED"));
}

// None of the boats has sent anything, so none can be identified.
TEST_F(SharedFleet, IsListedAndRefreshedAsAWhole) {
  ASSERT_NO_FATAL_FAILURE(StartBoth());
  const auto list = Start({"list"});
  EXPECT_EQ(list->Wait(), 0) << list->output();
  for (const std::string& boat : boats_) EXPECT_THAT(list->output(), HasSubstr(boat));
  const auto refresh = Start({"refresh", "--all"});
  EXPECT_EQ(refresh->Wait(), 3) << refresh->output();
  EXPECT_THAT(refresh->output(), HasSubstr("4 of 4 boats have no sound new model"));
  const auto some = Start({"refresh", "--vehicle-id", "boat-1", "boat-2", "nobody"});
  EXPECT_EQ(some->Wait(), 1) << some->output();
  EXPECT_THAT(some->output(), HasSubstr("refused 2, failed 1"));
}

// The other takes the slices over once their leases have run out, three seconds later at least.
TEST_F(SharedFleet, IsOnThePageOfTheDaemonThatServesIt) {
  const auto start = [this](const char* name) {
    const std::string config = ConfigOf(name, "slices { lease_s: 4 }\nhttp { port: 0 }\n");
    return std::make_unique<Process>(std::vector<std::string>{TELLTALED, "--config", config});
  };
  const auto boats_of = [](const Process& daemon) {
    const auto answer = httplib::Client(PageOf(daemon.output())).Get("/api/v1/vehicles");
    proto::VehicleList list;
    EXPECT_TRUE(google::protobuf::util::JsonStringToMessage(answer->body, &list).ok());
    return list.total();
  };
  one_ = start("one");
  ASSERT_TRUE(one_->WaitForOutput("serving 4 vehicles:")) << one_->output();
  while (boats_of(*one_) != 4) std::this_thread::yield();
  two_ = start("two");
  ASSERT_TRUE(two_->WaitForOutput("serving 2 vehicles:")) << two_->output();
  while (boats_of(*one_) != 2 || boats_of(*two_) != 2) std::this_thread::yield();
}

TEST_F(SharedFleet, IsListedInPartWhereADaemonIsSilent) {
  ASSERT_NO_FATAL_FAILURE(StartBoth());
  const Participant participant(domain_.id());
  FleetClient client(participant);
  FleetRequest list;
  list.command = FleetCommand::kList;
  list.correlation_id = "whole";
  const auto whole = client.Ask(list, {.match = 60s, .reply = 60s, .retry = 1s});
  ASSERT_EQ(whole.outcome, RequestOutcome::kAnswered);
  EXPECT_EQ(UnansweredSlices(list, *whole.reply), 0u);
  EXPECT_EQ(whole.reply->vehicles.size(), 4u);

  two_->Suspend();
  list.correlation_id = "part";
  const auto part = client.Ask(list, {.match = 60s, .reply = 1s, .retry = 1s});
  ASSERT_EQ(part.outcome, RequestOutcome::kAnswered);
  EXPECT_EQ(std::popcount(UnansweredSlices(list, *part.reply)), 32);
  EXPECT_EQ(part.reply->vehicles.size(), 2u);
  two_->Resume();
}

TEST_F(SharedFleet, IsLeftAloneByADaemonThatWasSuspendedForLongerThanItsLeases) {
  ASSERT_NO_FATAL_FAILURE(StartBoth());
  two_->Suspend();
  ASSERT_TRUE(one_->WaitForOutput("holds 64 of 64 slices, 32 of them newly"));
  two_->Resume();
  EXPECT_TRUE(two_->WaitForOutput("holds 0 of 64 slices"));
  EXPECT_EQ(OverlappingLeases(), 0);
}

TEST_F(SharedFleet, IsNotSharedByADaemonThatHasItAlone) {
  const auto alone = StartDaemon();
  Process second({TELLTALED, "--config", ConfigOf("second", "")});
  EXPECT_EQ(second.Wait(), 1);
  EXPECT_THAT(second.output(), HasSubstr("in use by another telltaled"));
}

TEST_F(SharedFleet, IsHandedOverByADaemonThatEnds) {
  ASSERT_NO_FATAL_FAILURE(StartBoth());
  two_->Signal(SIGTERM);
  EXPECT_EQ(two_->Wait(), 0);
  ASSERT_TRUE(one_->WaitForOutput("holds 64 of 64 slices, 32 of them newly"));
  EXPECT_EQ(OverlappingLeases(), 0);
}

}  // namespace
}  // namespace telltale
