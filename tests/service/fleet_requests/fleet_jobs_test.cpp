#include "telltale/service/fleet_requests/fleet_jobs.hpp"

#include <chrono>
#include <future>
#include <map>
#include <string>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/loopback_domain.hpp"
#include "support/temporary_folder.hpp"
#include "telltale/client/bus/reader.hpp"
#include "telltale/client/bus/wait_set.hpp"
#include "telltale/idl/codec/wire/fleet_exchange.hpp"

namespace telltale {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;

/// Jobs of a fleet without boats, and what they answer on the bus.
class FleetJobsTest : public ::testing::Test {
 protected:
  FleetJobsTest() {
    wait_set_.Attach(reader_, [this] {
      reader_.Take([this](const telltale_wire_FleetReply& wire) {
        const auto reply = Decode(wire);
        ASSERT_TRUE(reply.has_value());
        replies_seen_.insert_or_assign(reply->correlation_id, *reply);
      });
    });
  }

  static FleetRequest List(const std::string& correlation_id) {
    FleetRequest request;
    request.correlation_id = correlation_id;
    request.command = FleetCommand::kList;
    return request;
  }

  /// Nothing where none comes within a minute.
  std::optional<FleetReply> AwaitReply(const std::string& correlation_id) {
    const auto deadline = std::chrono::steady_clock::now() + 60s;
    while (!replies_seen_.contains(correlation_id) && std::chrono::steady_clock::now() < deadline) {
      wait_set_.Wait(100ms);
    }
    const auto found = replies_seen_.find(correlation_id);
    return found == replies_seen_.end() ? std::nullopt : std::optional(found->second);
  }

  FleetJobs Jobs(std::function<SliceSet()> served) {
    return {fleet_,
            models_,
            diagnoses_,
            replies_,
            journal_,
            std::move(served),
            {.submit = [](auto, auto) {}, .cancel = [](auto&) { return false; }}};
  }

  LoopbackDomain domain_;
  TemporaryFolder folder_;
  Storage storage_{folder_.Path()};
  Participant participant_{domain_.id()};
  Reader<telltale_wire_FleetReply> reader_{participant_};
  WaitSet wait_set_{participant_};
  Fleet fleet_{{}, WindowLimits()};
  Role role_{std::nullopt};
  PublishedModels models_{participant_, ModelStore(storage_), fleet_, role_};
  PublishedDiagnoses diagnoses_{participant_, DiagnosisStore(storage_)};
  ReplyPublisher replies_{participant_, role_};
  RequestJournal journal_{storage_};
  std::map<std::string, FleetReply> replies_seen_;  ///< by correlation id
};

// A thousand may wait, beside the one that is being answered.
TEST_F(FleetJobsTest, TellWhoComesWhileAThousandWaitToAskAgain) {
  std::promise<void> held;
  std::promise<void> begun;
  bool first = true;
  FleetJobs jobs = Jobs([&, go_on = held.get_future().share()] {
    if (std::exchange(first, false)) begun.set_value();
    go_on.wait();
    return kAllSlices;
  });
  jobs.Submit(List("first"));
  begun.get_future().wait();
  for (int number = 0; number < 1000; ++number)
    jobs.Submit(List("waits-" + std::to_string(number)));
  jobs.Submit(List("late"));
  const auto busy = AwaitReply("late");
  held.set_value();
  ASSERT_TRUE(busy);
  EXPECT_EQ(busy->outcome, ReplyOutcome::kFailed);
  EXPECT_GT(busy->retry_after_s, 0.0);
  EXPECT_THAT(busy->message, HasSubstr("1000 requests wait"));
  EXPECT_TRUE(AwaitReply("waits-999"));
  replies_seen_.erase("late");
  jobs.Submit(List("late"));
  const auto answered = AwaitReply("late");
  ASSERT_TRUE(answered);
  EXPECT_EQ(answered->outcome, ReplyOutcome::kAnswered);
}

TEST_F(FleetJobsTest, SayForWhichSlicesTheyAnswer) {
  FleetJobs jobs = Jobs([] { return SetOf(3) | SetOf(40); });
  jobs.Submit(List("some"));
  const auto reply = AwaitReply("some");
  ASSERT_TRUE(reply);
  EXPECT_EQ(reply->slices, SetOf(3) | SetOf(40));
}

}  // namespace
}  // namespace telltale
