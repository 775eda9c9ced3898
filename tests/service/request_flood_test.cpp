#include <signal.h>

#include <chrono>
#include <string>

#include <gtest/gtest.h>

#include "service/boat_and_client.hpp"
#include "service/service_fixture.hpp"
#include "telltale/client/bus/writer.hpp"
#include "telltale/idl/codec/wire/exchange.hpp"

namespace telltale {
namespace {

using namespace std::chrono_literals;

/// A client that asks and does not wait for answers.
class RequestFlood : public ServiceTest {
 protected:
  static constexpr int kRequests = 20'000;
  static constexpr int kSentAtOnce = 32;

  void Send(const std::string& vehicle_id) {
    const Participant participant(domain_.id());
    Writer<telltale_wire_IdentifyRequest> requests(participant);
    ASSERT_TRUE(WaitForMatch(participant, {requests}, 60s));
    for (int i = 0; i < kRequests; ++i) {
      IdentifyRequest request = Request("flood-" + std::to_string(i));
      request.vehicle_id = vehicle_id;
      request.estimator = Estimator::kOneStep;
      request.seed = static_cast<std::uint64_t>(i);  // unlike any other, so that it joins none
      request.deadline_s = 5.0;
      requests.Write(Encode(request));
      // A reader keeps 64 at most: each is to arrive.
      if (i % kSentAtOnce > 0) continue;
      ASSERT_TRUE(requests.AwaitReceipt(60s));
    }
    EXPECT_TRUE(requests.AwaitReceipt(60s));
  }

  /// The daemon answers somebody else, and logs at most 200 requests in ten seconds.
  void ExpectService(Process& daemon) {
    const auto identify = Start({"identify", "--vehicle-id", kVehicleId});
    EXPECT_EQ(identify->Wait(), 0) << identify->output();
    daemon.Signal(SIGTERM);
    EXPECT_EQ(daemon.Wait(), 0);
    EXPECT_LE(FloodLines(daemon.output()), 200 * (1 + SecondsSince(start_) / 10));
  }

 private:
  static std::size_t FloodLines(const std::string& log) {
    std::size_t lines = 0;
    for (auto at = log.find("flood-"); at != std::string::npos; at = log.find("flood-", at + 1)) {
      ++lines;
    }
    return lines;
  }

  CampaignClock::time_point start_ = CampaignClock::now();
};

TEST_F(RequestFlood, ForABoatIsBoundedByTheQueueAndItsDeadlines) {
  const auto daemon = StartDaemon();
  ReplaySimulation();
  Send(kVehicleId);
  ExpectService(*daemon);
}

TEST_F(RequestFlood, ForABoatThatIsNotServedIsAnsweredAtOnce) {
  const auto daemon = StartDaemon();
  ReplaySimulation();
  Send("unknown");
  ExpectService(*daemon);
}

}  // namespace
}  // namespace telltale
