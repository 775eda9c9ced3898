#include <signal.h>

#include <chrono>
#include <memory>
#include <set>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "service/repeated_request.hpp"
#include "service/service_fixture.hpp"
#include "support/stable_boat.hpp"
#include "telltale/client/bus/reader.hpp"
#include "telltale/client/bus/wait_set.hpp"
#include "telltale/client/bus/writer.hpp"
#include "telltale/idl/codec/wire/exchange.hpp"
#include "telltale/service/jobs/job.hpp"

namespace telltale {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;
using ::testing::Not;

using SomeAsker = Asker<IdentifyReply>;

TEST(Asker, IsGoneOnceTheBusHasLostItForLong) {
  const auto now = SomeAsker::Clock::now();
  SomeAsker asker;
  EXPECT_FALSE(asker.IsGoneBy(now));
  EXPECT_FALSE(asker.WaitsUntil());
  asker.gone_since = now;
  EXPECT_FALSE(asker.IsGoneBy(now + kClientPatience - 1ms));
  EXPECT_TRUE(asker.IsGoneBy(now + kClientPatience));
  EXPECT_EQ(asker.WaitsUntil(), now + kClientPatience);
  asker.deadline = now + 1s;
  EXPECT_EQ(asker.WaitsUntil(), now + 1s);
}

/// Coverage checks of minutes, of which a daemon computes one at a time.
class VanishedClient : public ServiceTest {
 protected:
  /// A client, and the id of its request.
  struct Client {
    std::unique_ptr<Process> process;
    std::string correlation_id;
  };

  /// Returns once the daemon knows of the request.
  Client AskForMinutes(int seed) {
    Client client;
    client.process = Start({"identify", "--vehicle-id", kVehicleId, "--check-coverage", "1000",
                            "--seed", std::to_string(seed), "--timeout", "3600"});
    client.correlation_id = AwaitProgress([this](const IdentifyProgress& report) {
      return known_.insert(report.correlation_id).second;
    });
    return client;
  }

  /// By a writer of its own, which is gone once the daemon knows of the request.
  void AskAndLeave(const std::string& correlation_id) {
    const Participant participant(domain_.id());
    Writer<telltale_wire_IdentifyRequest> requests(participant);
    IdentifyRequest request = Request(correlation_id);
    request.seed = 99;
    request.coverage_check_replicates = 1000;
    known_.insert(correlation_id);
    AskUntilReported(participant, requests, request);
  }

  void AwaitBegun(const std::string& correlation_id) {
    AwaitProgress([&](const IdentifyProgress& report) {
      return report.correlation_id == correlation_id &&
             report.stage.find("checking coverage") != std::string::npos;
    });
  }

  /// The id of the request that reports so.
  template <class IsIt>
  std::string AwaitProgress(IsIt is_it) {
    std::string correlation_id;
    WaitSet wait_set(participant_);
    wait_set.Attach(progress_, [&] {
      progress_.Take([&](const telltale_wire_IdentifyProgress& sample) {
        const auto report = Decode(sample);
        if (report && correlation_id.empty() && is_it(*report)) {
          correlation_id = report->correlation_id;
        }
      });
    });
    const auto deadline = std::chrono::steady_clock::now() + 120s;
    while (correlation_id.empty() && std::chrono::steady_clock::now() < deadline) wait_set.Wait(1s);
    EXPECT_FALSE(correlation_id.empty());
    return correlation_id;
  }

  Participant participant_{domain_.id()};
  Reader<telltale_wire_IdentifyProgress> progress_{participant_};
  std::set<std::string> known_;
};

// One runs, one waits, and one has asked for the same as another that stays. A fifth comes back by
// another writer.
TEST_F(VanishedClient, IsWorkedForNoMoreUnlessAnotherWaitsOrItComesBack) {
  const auto daemon = StartDaemon();
  Replay(SimulatedRecording(testing::StableBoat(), 0.0, 300.0, 4));
  ASSERT_TRUE(WaitForMatch(participant_, {progress_}, 60s));
  const Client runs = AskForMinutes(1);
  AwaitBegun(runs.correlation_id);
  const Client waits = AskForMinutes(2);
  const Client shares = AskForMinutes(3);
  const Client stays = AskForMinutes(3);
  AskAndLeave("comes-back");
  const Participant again(domain_.id());
  Writer<telltale_wire_IdentifyRequest> requests(again);
  AskUntilReported(again, requests, Request("comes-back"));

  for (const Client* client : {&runs, &waits, &shares}) client->process->Signal(SIGKILL);
  for (const Client* client : {&runs, &waits, &shares}) {
    EXPECT_TRUE(
        daemon->WaitForOutput(client->correlation_id + " is dropped: its client is gone", 120s))
        << daemon->output();
  }
  EXPECT_TRUE(daemon->WaitForOutput("nobody waits for it any more")) << daemon->output();
  AwaitBegun(stays.correlation_id);
  EXPECT_THAT(daemon->output(), Not(HasSubstr("comes-back is dropped")));
}

}  // namespace
}  // namespace telltale
