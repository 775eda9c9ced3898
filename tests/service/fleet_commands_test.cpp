#include <signal.h>

#include <chrono>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "service/repeated_request.hpp"
#include "service/service_fixture.hpp"
#include "support/stable_boat.hpp"
#include "telltale/client/bus/reader.hpp"
#include "telltale/client/bus/wait_set.hpp"
#include "telltale/client/bus/writer.hpp"
#include "telltale/client/fleet/fleet_client.hpp"
#include "telltale/client/recording/file_contents.hpp"
#include "telltale/core/paper/yellowfish.hpp"
#include "telltale/idl/codec/vehicle_file.hpp"

namespace telltale {
namespace {

using namespace std::chrono_literals;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

/// A daemon that serves the yellowfish and two boats that never speak.
class FleetCommands : public ServiceTest {
 protected:
  FleetCommands() { Configure("bootstrap_replicates: 100 structure: \"static\""); }

  void Configure(const std::string& identification) {
    Vehicle vehicle = YellowfishVehicle();
    std::vector<std::string> files;
    for (const char* id : {kVehicleId, "silent-1", "silent-2"}) {
      vehicle.vehicle_id = id;
      files.push_back(std::string(id) + ".textproto");
      folder_.Write(files.back(), PrintVehicle(vehicle));
    }
    ConfigureIdentification(identification, files);
  }

  /// What `telltale` says, after it has exited with this code.
  std::string Output(const std::vector<std::string>& arguments, int exit_code) const {
    const auto command = Start(arguments);
    EXPECT_EQ(command->Wait(), exit_code) << command->output();
    return command->output();
  }

  FleetResult Ask(const FleetRequest& request) const {
    const Participant participant(domain_.id());
    FleetClient client(participant);
    return client.Ask(request, {.match = 60s, .reply = 60s, .retry = 1s});
  }
};

TEST_F(FleetCommands, ListTheBoatsAndTheModelsOfEach) {
  const auto daemon = StartDaemon(3);
  EXPECT_THAT(Output({"list"}, 0), AllOf(HasSubstr("silent-1"), HasSubstr("none")));
  EXPECT_THAT(Output({"history", "--vehicle-id", kVehicleId}, 0), HasSubstr("has no model yet"));
  EXPECT_THAT(Output({"history", "--vehicle-id", "nobody"}, 1), HasSubstr("is not served here"));
  ReplaySimulation();
  for (const char* seed : {"1", "2"}) {
    Start({"identify", "--vehicle-id", kVehicleId, "--seed", seed})->Wait();
  }
  EXPECT_THAT(Output({"list", "--json"}, 0),
              AllOf(HasSubstr("\"vehicleId\": \"yellowfish\""), HasSubstr("\"revision\": 2")));
  EXPECT_THAT(Output({"history", "--vehicle-id", kVehicleId}, 0),
              AllOf(HasSubstr("revision"), HasSubstr("\n       2"), HasSubstr("\n       1")));

  EXPECT_THAT(Output({"rollback", "--vehicle-id", kVehicleId, "--revision", "1"}, 0),
              HasSubstr("published again as revision 3"));
  EXPECT_THAT(Output({"rollback", "--vehicle-id", kVehicleId, "--revision", "99"}, 1),
              HasSubstr("revision = 99"));
  EXPECT_THAT(Output({"rollback", "--vehicle-id", kVehicleId, "--revision", "no"}, 2),
              HasSubstr("--revision"));
  EXPECT_THAT(Output({"watch", "--vehicle-id", kVehicleId, "--count", "1", "--timeout", "60"}, 0),
              AllOf(HasSubstr("revision 3"), HasSubstr("revision 1 published again")));
}

TEST_F(FleetCommands, RefreshEveryBoatAndSaysWhatBecomesOfEach) {
  auto daemon = StartDaemon(3);
  Replay(SimulatedRecording(testing::StableBoat(), 0.0, 300.0, 4));
  // The silent boats have nothing to identify.
  const std::string first = Output({"refresh", "--all"}, 3);
  EXPECT_THAT(first,
              AllOf(HasSubstr("yellowfish: PUBLISHED revision 1"), HasSubstr("silent-1: REFUSED"),
                    HasSubstr("3 boats in"), HasSubstr("published 1"), HasSubstr("refused 2"),
                    HasSubstr("2 of 3 boats have no sound new model")));
  EXPECT_THAT(Output({"refresh", "--vehicle-id", kVehicleId}, 0),
              AllOf(HasSubstr("yellowfish: UNCHANGED"), Not(HasSubstr("silent"))));
  EXPECT_THAT(Output({"refresh", "--vehicle-id", kVehicleId, "--older-than", "7d"}, 0),
              HasSubstr("no boat meets the conditions"));
  EXPECT_THAT(Output({"refresh", "--vehicle-id", kVehicleId, "nobody", "--json"}, 1),
              AllOf(HasSubstr("\"unchanged\": 1"), HasSubstr("\"failed\": 1"),
                    HasSubstr("is not served here")));

  for (const auto& wrong :
       std::vector<std::vector<std::string>>{{"refresh"},
                                             {"refresh", "--all", "--vehicle-id", "one"},
                                             {"refresh", "--older-than", "soon"},
                                             {"refresh", "--worse-than", "BAD"},
                                             {"refresh", "--all", "--cancel", "x"}}) {
    Output(wrong, 2);
  }
  EXPECT_THAT(Output({"refresh", "--follow", "unknown"}, 1), HasSubstr("no refresh 'unknown'"));
  EXPECT_THAT(Output({"refresh", "--cancel", "unknown"}, 1), HasSubstr("no request 'unknown'"));
}

TEST_F(FleetCommands, FollowARefreshThatAnotherBegan) {
  const auto daemon = StartDaemon(3);
  FleetRequest refresh;
  refresh.correlation_id = "first";
  refresh.command = FleetCommand::kRefresh;
  refresh.all = true;
  ASSERT_EQ(Ask(refresh).outcome, RequestOutcome::kAnswered);
  FleetRequest follow;
  follow.correlation_id = "second";
  follow.command = FleetCommand::kFollow;
  follow.target = "first";
  const auto followed = Ask(follow);
  ASSERT_EQ(followed.outcome, RequestOutcome::kAnswered);
  EXPECT_EQ(followed.reply->refreshed.size(), 3u);
  EXPECT_TRUE(daemon->WaitForOutput("the refresh first ended"));
}

// The boat with telemetry takes minutes; the silent ones are through at once.
TEST_F(FleetCommands, GoOnWithARefreshWhoseClientIsInterrupted) {
  // Seconds of work, so that it is under way until it is cancelled.
  Configure("structure: \"fossen\"");
  const auto daemon = StartDaemon(3);
  Replay(SimulatedRecording(testing::StableBoat(), 0.0, 900.0, 4));
  const auto client = Start({"refresh", "--all"});
  ASSERT_TRUE(client->WaitForOutput("silent-1: REFUSED"));
  client->Signal(SIGINT);
  EXPECT_EQ(client->Wait(), 130);
  const std::string said = client->output();
  EXPECT_THAT(said, HasSubstr("the refresh goes on"));
  const auto named = said.find("--cancel ") + 9;
  const std::string id = said.substr(named, said.find(' ', named) - named);
  const auto follower = Start({"refresh", "--follow", id});
  ASSERT_TRUE(follower->WaitForOutput("silent-1: REFUSED"));
  EXPECT_THAT(Output({"refresh", "--cancel", id}, 0), HasSubstr("is cancelled"));
  EXPECT_EQ(follower->Wait(), 1);
  EXPECT_THAT(follower->output(), HasSubstr("yellowfish: CANCELLED"));
}

TEST_F(FleetCommands, SayThatARefreshIsNotConfirmedWhereNoDaemonAnswers) {
  const auto client = Start({"refresh", "--all"});
  ASSERT_TRUE(client->WaitForOutput("elsewhere: telltale refresh --follow"));
  client->Signal(SIGTERM);
  EXPECT_EQ(client->Wait(), 143);
  EXPECT_THAT(client->output(), HasSubstr("has not confirmed the refresh"));
}

// A coverage check of a thousand replicates takes minutes; it is cancelled from elsewhere.
TEST_F(FleetCommands, CancelARequest) {
  const auto daemon = StartDaemon(3);
  Replay(SimulatedRecording(testing::StableBoat(), 0.0, 300.0, 4));
  const Participant participant(domain_.id());
  Reader<telltale_wire_IdentifyReply> replies(participant);
  IdentifyRequest long_one = Request("minutes");
  long_one.coverage_check_replicates = 1000;
  Writer<telltale_wire_IdentifyRequest> requests(participant);
  AskUntilReported(participant, requests, long_one);
  // While it goes on, another is answered.
  IdentificationClient client(participant);
  EXPECT_EQ(client.Identify(Request("plain"), {.match = 60s, .reply = 60s, .retry = 1s}).outcome,
            RequestOutcome::kPublished);
  EXPECT_THAT(Output({"refresh", "--cancel", "minutes"}, 0), HasSubstr("is cancelled"));
  std::string message;
  WaitSet wait_set(participant);
  wait_set.Attach(replies, [&] {
    replies.Take([&](const telltale_wire_IdentifyReply& reply) {
      const auto decoded = Decode(reply);
      if (decoded && decoded->correlation_id == "minutes") message = decoded->message;
    });
  });
  for (int patience = 0; patience < 60 && message.empty(); ++patience) wait_set.Wait(1s);
  EXPECT_THAT(message, HasSubstr("cancelled"));
}

}  // namespace
}  // namespace telltale
