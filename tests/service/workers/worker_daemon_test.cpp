#include <signal.h>

#include <chrono>
#include <future>
#include <memory>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "service/service_fixture.hpp"
#include "support/notify_socket.hpp"
#include "support/stable_boat.hpp"
#include "telltale/client/fleet/identification_client.hpp"
#include "telltale/client/recording/telemetry_log/telemetry_log.hpp"
#include "telltale/idl/codec/json/model.hpp"

namespace telltale {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;
using ::testing::Not;

/// A daemon and workers, each a process of its own, over a real server.
class WorkerDaemon : public ServiceTest {
 protected:
  WorkerDaemon() : ServiceTest(Engine::kPostgres) { Configure("workers {}\n"); }

  std::unique_ptr<Process> StartWorker() const {
    auto worker = std::make_unique<Process>(
        std::vector<std::string>{TELLTALED, "--worker", "--config", config_file_});
    EXPECT_TRUE(worker->WaitForOutput("waiting for jobs")) << worker->output();
    return worker;
  }

  /// A coverage check that takes a second or so, or many minutes.
  IdentifyRequest QuickCheck(const std::string& correlation_id) const {
    IdentifyRequest request = LongCheck(correlation_id);
    request.estimator = Estimator::kOneStep;
    request.coverage_check_replicates = 300;
    return request;
  }
  IdentifyRequest LongCheck(const std::string& correlation_id) const {
    IdentifyRequest request = Request(correlation_id);
    request.bootstrap_replicates = 0;
    request.coverage_check_replicates = 1000;
    return request;
  }

  IdentifyResult Identify(const IdentifyRequest& request) const {
    const Participant participant(domain_.id());
    IdentificationClient client(participant);
    return client.Identify(request, {.match = 60s, .reply = 300s, .retry = 1s});
  }

  /// The same beside what the test does meanwhile.
  std::future<IdentifyResult> IdentifyMeanwhile(const IdentifyRequest& request) const {
    return std::async(std::launch::async, [this, request] { return Identify(request); });
  }
};

/// What does not tell one revision from another.
std::string NumbersOf(const IdentifyReply& reply) {
  Identification identification = reply.model->identification;
  identification.provenance = {};
  return PrintModelJson(identification);
}

TEST_F(WorkerDaemon, TellsTheServiceManagerThatAWorkerIsReadyAndThatItStops) {
  NotifySocket manager(folder_.Path() / "notify", 0s);
  const auto worker = StartWorker();
  EXPECT_TRUE(manager.Await("READY=1")) << worker->output();
  worker->Signal(SIGTERM);
  EXPECT_TRUE(manager.Await("STOPPING=1")) << worker->output();
  EXPECT_EQ(worker->Wait(), 0) << worker->output();
}

TEST_F(WorkerDaemon, HasTheNumbersThatItComputesItself) {
  const auto daemon = StartDaemon();
  ReplaySimulation();
  const auto alone = Identify(QuickCheck("alone"));
  ASSERT_EQ(alone.outcome, RequestOutcome::kPublished) << daemon->output();
  EXPECT_THAT(daemon->output(), HasSubstr("for alone: no worker is alive"));

  const auto worker = StartWorker();
  const auto shared = Identify(QuickCheck("shared"));
  ASSERT_EQ(shared.outcome, RequestOutcome::kPublished) << daemon->output() << worker->output();
  EXPECT_THAT(daemon->output(), Not(HasSubstr("for shared: no worker is alive")));
  EXPECT_TRUE(worker->WaitForOutput("of yellowfish for shared is begun, attempt 1"));
  EXPECT_EQ(shared.reply->model->revision, 2u);
  EXPECT_TRUE(shared.reply->model->identification.coverage_check);
  EXPECT_EQ(NumbersOf(*shared.reply), NumbersOf(*alone.reply));
  EXPECT_EQ(shared.reply->model->promotion, alone.reply->model->promotion);
}

// It is suspended at once, so that it cannot have ended before.
TEST_F(WorkerDaemon, IsServedByAnotherWorkerWhenOneIsKilled) {
  const auto daemon = StartDaemon();
  ReplaySimulation();
  const auto one = StartWorker();
  auto result = IdentifyMeanwhile(QuickCheck("owed"));
  ASSERT_TRUE(one->WaitForOutput("for owed is begun, attempt 1")) << daemon->output();
  one->Suspend();
  const auto two = StartWorker();
  one->Signal(SIGKILL);
  ASSERT_EQ(result.get().outcome, RequestOutcome::kPublished) << daemon->output();
  EXPECT_THAT(daemon->output(), HasSubstr("has not finished it"));
  EXPECT_TRUE(two->WaitForOutput("for owed is begun, attempt 2"));
}

TEST_F(WorkerDaemon, ComputesItselfWhatItsLastWorkerLeaves) {
  const auto daemon = StartDaemon();
  ReplaySimulation();
  const auto worker = StartWorker();
  auto result = IdentifyMeanwhile(QuickCheck("left"));
  ASSERT_TRUE(worker->WaitForOutput("for left is begun")) << daemon->output();
  worker->Signal(SIGKILL);
  ASSERT_EQ(result.get().outcome, RequestOutcome::kPublished) << daemon->output();
  EXPECT_THAT(daemon->output(), HasSubstr("for left: no worker is alive"));
}

TEST_F(WorkerDaemon, TakesBackAtOnceWhatAWorkerThatEndsGivesBack) {
  const auto daemon = StartDaemon();
  ReplaySimulation();
  const auto one = StartWorker();
  auto result = IdentifyMeanwhile(QuickCheck("back"));
  ASSERT_TRUE(one->WaitForOutput("for back is begun, attempt 1")) << daemon->output();
  one->Suspend();
  const auto two = StartWorker();
  one->Signal(SIGTERM);
  one->Resume();
  ASSERT_EQ(result.get().outcome, RequestOutcome::kPublished) << daemon->output();
  EXPECT_EQ(one->Wait(), 0);
  EXPECT_THAT(one->output(), HasSubstr("is given back"));
  EXPECT_TRUE(two->WaitForOutput("for back is begun, attempt 1"));
}

TEST_F(WorkerDaemon, EndsTheWorkOfAWorkerOnARequestThatIsCancelled) {
  const auto daemon = StartDaemon();
  ReplaySimulation();
  const auto worker = StartWorker();
  auto result = IdentifyMeanwhile(LongCheck("minutes"));
  ASSERT_TRUE(worker->WaitForOutput("for minutes is begun")) << daemon->output();
  Run({"refresh", "--cancel", "minutes"});
  EXPECT_EQ(result.get().outcome, RequestOutcome::kFailed);
  EXPECT_TRUE(worker->WaitForOutput("nobody waits for it any more")) << worker->output();
}

TEST_F(WorkerDaemon, HasItsDiagnosesFromAWorker) {
  const auto daemon = StartDaemon();
  Replay(SimulatedRecording(testing::StableBoat(), 0.0, 300.0, 4));
  const auto worker = StartWorker();
  Run({"identify", "--vehicle-id", kVehicleId});
  Replay(SimulatedRecording(testing::StableBoat(), 301.0, 120.0, 2));
  const auto diagnose = Start({"diagnose", "--vehicle-id", kVehicleId});
  ASSERT_EQ(diagnose->Wait(), 0) << diagnose->output() << daemon->output();
  EXPECT_THAT(diagnose->output(), HasSubstr("Held against revision 1 of yellowfish"));
  EXPECT_TRUE(daemon->WaitForOutput("diagnosis of yellowfish for"));
  EXPECT_THAT(daemon->output(), Not(HasSubstr("no worker is alive")));
  EXPECT_TRUE(worker->WaitForOutput("is ended in"));
}

// No configuration of the worker names the boat: its particulars come with the job.
TEST_F(WorkerDaemon, ComputesForABoatThatHasAnnouncedItself) {
  ConfigureIdentification("bootstrap_replicates: 0", {});
  Configure("workers {}\n");
  const auto worker = StartWorker();
  Configure("announced { admit: \"yellow*\" }\n");
  const auto daemon = StartDaemon(0);
  WriteTelemetryLog(folder_.Path() / "log", SimulatedRecording());
  Run({"replay", "--log", folder_.Path() / "log", "--announce",
       folder_.Path() / "vehicle.textproto", "--speed", "60"});
  const auto result = Identify(QuickCheck("announced"));
  ASSERT_EQ(result.outcome, RequestOutcome::kPublished) << daemon->output();
  EXPECT_TRUE(worker->WaitForOutput("of yellowfish for announced is begun, attempt 1"));
  EXPECT_THAT(daemon->output(), Not(HasSubstr("no worker is alive")));
}

TEST_F(WorkerDaemon, IsNotMadeWithoutADatabaseToMeetIn) {
  const auto config = folder_.Write("alone.textproto", "state_directory: \"state\"\n");
  Process worker({TELLTALED, "--worker", "--config", config});
  EXPECT_EQ(worker.Wait(), 2);
  EXPECT_THAT(worker.output(), HasSubstr("workers"));
  EXPECT_THAT(worker.output(), HasSubstr("database"));
}

}  // namespace
}  // namespace telltale
