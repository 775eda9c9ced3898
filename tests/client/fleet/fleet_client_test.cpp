#include "telltale/client/fleet/fleet_client.hpp"

#include <atomic>
#include <chrono>
#include <map>
#include <string>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/loopback_domain.hpp"

namespace telltale {
namespace {

using namespace std::chrono_literals;
using ::testing::ElementsAre;
using ::testing::Pair;

FleetReply RefreshedBy(SliceSet slices, const std::string& vehicle_id, RefreshState state) {
  FleetReply reply;
  reply.outcome = ReplyOutcome::kAnswered;
  reply.slices = slices;
  reply.refreshed = {{vehicle_id, state, 0, PromotionVerdict::kUnknown, ""}};
  return reply;
}

/// A daemon that shares the fleet: for its slices it has ended the refresh that is asked for. The
/// others end theirs on `EndOthers()`, and it stands for them too.
class FakeSharedDaemon {
 public:
  explicit FakeSharedDaemon(const Participant& participant)
      : wait_set_(participant),
        progress_(participant),
        replies_(participant),
        requests_(participant) {
    wait_set_.Attach(requests_, [this] {
      requests_.Take([this](const auto& request) {
        Reply(request.correlation_id, RefreshedBy(0xff, "boat-1", RefreshState::kPublished));
        if (others_end_) {
          Reply(request.correlation_id,
                RefreshedBy(~SliceSet{0xff}, "boat-2", RefreshState::kRefused));
        }
      });
    });
    thread_ = std::thread([this] {
      while (!stopping_) wait_set_.Wait(100ms);
    });
  }
  FakeSharedDaemon(const FakeSharedDaemon&) = delete;
  FakeSharedDaemon& operator=(const FakeSharedDaemon&) = delete;
  ~FakeSharedDaemon() {
    stopping_ = true;
    wait_set_.Wake();
    thread_.join();
  }

  void EndOthers() { others_end_ = true; }

 private:
  void Reply(const char* correlation_id, FleetReply reply) {
    reply.correlation_id = correlation_id;
    replies_.Write(Encode(reply));
  }

  std::atomic<bool> others_end_ = false;
  WaitSet wait_set_;
  Writer<telltale_wire_FleetProgress> progress_;
  Writer<telltale_wire_FleetReply> replies_;
  Reader<telltale_wire_FleetRequest> requests_;
  std::atomic<bool> stopping_ = false;
  std::thread thread_;
};

// Others go on until the client has been told what became of boat-1.
TEST(FleetClient, ShowsTheVehiclesOfADaemonThatHasEndedWhileOthersGoOn) {
  const LoopbackDomain domain;
  const Participant here(domain.id());
  const Participant there(domain.id());
  FakeSharedDaemon daemon(there);
  FleetClient client(here);
  FleetRequest follow;
  follow.command = FleetCommand::kFollow;
  follow.correlation_id = "follow";
  follow.target = "refresh";
  std::map<std::string, RefreshState> shown;
  const FleetResult result = client.Ask(follow, {.match = 60s, .reply = 60s, .retry = 100ms},
                                        [&](const FleetProgress& progress) {
                                          for (const auto& vehicle : progress.vehicles) {
                                            shown[vehicle.vehicle_id] = vehicle.state;
                                          }
                                          if (shown.contains("boat-1")) daemon.EndOthers();
                                        });
  EXPECT_EQ(result.outcome, RequestOutcome::kAnswered);
  EXPECT_THAT(shown, ElementsAre(Pair("boat-1", RefreshState::kPublished),
                                 Pair("boat-2", RefreshState::kRefused)));
}

}  // namespace
}  // namespace telltale
