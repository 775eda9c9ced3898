#include <signal.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "service/service_fixture.hpp"
#include "support/stable_boat.hpp"
#include "telltale/client/fleet/identification_client.hpp"
#include "telltale/core/data/recording_parts.hpp"
#include "telltale/service/models/model_store.hpp"

namespace telltale {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;

/// A daemon whose server of PostgreSQL goes away.
class Outage : public ServiceTest {
 protected:
  Outage() : ServiceTest(Engine::kPostgres) {}

  std::optional<Quality> AwaitNotSaved(bool wanted) const {
    return AwaitQuality(kVehicleId, [&](const Quality& quality) {
      return wanted == std::ranges::any_of(quality.reasons, [](const QualityReason& reason) {
               return reason.code == "NOT_SAVED";
             });
    });
  }

  /// Five minutes of one run.
  static Recording Minutes(double start_s) {
    static const Recording run = SimulatedRecording(testing::StableBoat(), 0.0, 600.0, 4);
    return Between(run, start_s, start_s + 300.0);
  }
};

TEST_F(Outage, LeavesTheDaemonUpAndItSaysWhatItCannotDo) {
  auto daemon = StartDaemon();
  Replay(Minutes(0.0));
  ASSERT_TRUE(AwaitSavedWindow());
  EXPECT_EQ(Start({"identify", "--vehicle-id", kVehicleId})->Wait(), 0);

  engine_.Server().Stop();
  Replay(Minutes(300.0));
  const auto held = AwaitQuality(kVehicleId, [](const Quality& q) { return q.window_s > 599.0; });
  ASSERT_TRUE(held);
  EXPECT_TRUE(AwaitNotSaved(true));
  EXPECT_TRUE(daemon->WaitForOutput("telemetry is taken in and not saved"));
  const auto refused = Start({"identify", "--vehicle-id", kVehicleId, "--timeout", "5"});
  EXPECT_NE(refused->Wait(), 0);
  EXPECT_THAT(refused->output(), HasSubstr("PostgreSQL"));
  EXPECT_NE(Start({"history", "--vehicle-id", kVehicleId, "--timeout", "5"})->Wait(), 0);

  engine_.Server().Start();
  EXPECT_TRUE(daemon->WaitForOutput("windows are saved again"));
  EXPECT_TRUE(AwaitNotSaved(false));
  ASSERT_TRUE(AwaitSavedWindow());
  EXPECT_EQ(Start({"identify", "--vehicle-id", kVehicleId})->Wait(), 0);
  daemon->Signal(SIGKILL);
  daemon->Wait();
  daemon = StartDaemon();
  const auto restored = AwaitQuality(kVehicleId, [](const Quality&) { return true; });
  ASSERT_TRUE(restored);
  EXPECT_NEAR(restored->window_s, held->window_s, 1.0);
  EXPECT_EQ(ModelStore(Storage()).History(kVehicleId).size(), 2u);
}

// The client is told that the request is queued, which means that it is in the database.
TEST_F(Outage, LosesNoAcknowledgedRequest) {
  const auto daemon = StartDaemon();
  Replay(Minutes(0.0));
  ASSERT_TRUE(AwaitSavedWindow());
  const Participant participant(domain_.id());
  IdentificationClient client(participant);
  const IdentifyRequest request = Request("acknowledged");
  bool stopped = false;
  const auto result = client.Identify(
      request, {.match = 60s, .reply = 120s, .retry = 1s}, [&](const IdentifyProgress&) {
        if (std::exchange(stopped, true)) return;
        engine_.Server().Stop();
        EXPECT_TRUE(daemon->WaitForOutput("for acknowledged: FAILED"));
        engine_.Server().Start();
      });
  EXPECT_TRUE(stopped);
  EXPECT_EQ(result.outcome, RequestOutcome::kPublished);
  EXPECT_EQ(ModelStore(Storage()).History(kVehicleId).size(), 1u);
}

}  // namespace
}  // namespace telltale
