#include <signal.h>

#include <chrono>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "service/service_fixture.hpp"
#include "support/stable_boat.hpp"
#include "telltale/client/fleet/identification_client.hpp"

namespace telltale {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;
using ::testing::Not;

class KilledDaemon : public ServiceTest, public ::testing::WithParamInterface<Engine> {
 protected:
  KilledDaemon() : ServiceTest(GetParam()) {}
};

INSTANTIATE_TEST_SUITE_P(Engines, KilledDaemon, kEngines, EngineName);

// Before, the data could not answer for minutes, and the first thin model replaced a good one.
TEST_P(KilledDaemon, IdentifiesAtOnceFromTheWindowThatItHad) {
  auto daemon = StartDaemon();
  Replay(SimulatedRecording(testing::StableBoat(), 0.0, 300.0, 4));
  const auto held = AwaitQuality(kVehicleId, [](const Quality& q) { return q.window_s > 299.0; });
  ASSERT_TRUE(held);
  ASSERT_TRUE(AwaitSavedWindow());
  daemon->Signal(SIGKILL);
  daemon->Wait();

  daemon = StartDaemon();
  EXPECT_TRUE(daemon->WaitForOutput("the windows of 1 vehicles are read back"));
  const auto restored = AwaitQuality(kVehicleId, [](const Quality&) { return true; });
  ASSERT_TRUE(restored);
  EXPECT_NEAR(restored->window_s, held->window_s, 1.0);
  EXPECT_TRUE(restored->rejected.empty());
  EXPECT_EQ(Start({"identify", "--vehicle-id", kVehicleId})->Wait(), 0);
}

// The client is told that the request is queued, which means that it is on disk.
TEST_P(KilledDaemon, FinishesAcknowledgedRequestsAfterItsRestart) {
  auto daemon = StartDaemon();
  Replay(SimulatedRecording(testing::StableBoat(), 0.0, 90.0, 4));
  ASSERT_TRUE(AwaitSavedWindow());
  const Participant participant(domain_.id());
  IdentificationClient client(participant);
  IdentifyRequest request = Request("acknowledged");
  request.structure = Structure::kFossen;  // a second of work
  bool killed = false;
  const auto result = client.Identify(
      request, {.match = 60s, .reply = 120s, .retry = 1s}, [&](const IdentifyProgress&) {
        if (killed) return;
        killed = true;
        daemon->Signal(SIGKILL);
        daemon->Wait();
        daemon = StartDaemon();
        EXPECT_TRUE(daemon->WaitForOutput("1 requests of the run before"));
      });
  EXPECT_TRUE(killed);
  EXPECT_EQ(result.outcome, RequestOutcome::kPublished);
  EXPECT_TRUE(daemon->WaitForOutput("for acknowledged: PUBLISHED"));
}

// A service manager starts it again each time, for ever where the request is what ends it.
TEST_P(KilledDaemon, GivesUpARequestThatItHasTakenUpThreeTimes) {
  auto daemon = StartDaemon();
  Replay(SimulatedRecording(testing::StableBoat(), 0.0, 90.0, 4));
  ASSERT_TRUE(AwaitSavedWindow());
  const Participant participant(domain_.id());
  IdentificationClient client(participant);
  IdentifyRequest request = Request("deadly");
  request.coverage_check_replicates = 1000;  // minutes of work
  int killed = 0;
  const auto result = client.Identify(
      request, {.match = 60s, .reply = 120s, .retry = 1s}, [&](const IdentifyProgress& progress) {
        if (progress.stage == "queued") return;
        ++killed;  // also by a report of the daemon before, as it comes late
        daemon->Signal(SIGKILL);
        daemon->Wait();
        daemon = StartDaemon();
      });
  EXPECT_GE(killed, 4);
  EXPECT_EQ(result.outcome, RequestOutcome::kFailed);
  EXPECT_THAT(result.reply->message, HasSubstr("each of the 3 times that it took it up again"));
  EXPECT_THAT(daemon->output(), HasSubstr("for deadly: FAILED"));
}

TEST_P(KilledDaemon, ForgetsRequestsThatItHasAnswered) {
  auto daemon = StartDaemon();
  EXPECT_EQ(Start({"identify", "--vehicle-id", kVehicleId})->Wait(), 3);
  daemon->Signal(SIGTERM);
  EXPECT_EQ(daemon->Wait(), 0);
  daemon = StartDaemon();
  EXPECT_THAT(daemon->output(), Not(HasSubstr("requests of the run before")));
}

}  // namespace
}  // namespace telltale
