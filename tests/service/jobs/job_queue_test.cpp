#include "telltale/service/jobs/job_queue.hpp"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <spdlog/spdlog.h>

#include "support/loopback_domain.hpp"
#include "telltale/client/bus/reader.hpp"
#include "telltale/client/bus/wait_set.hpp"
#include "telltale/core/paper/yellowfish.hpp"
#include "telltale/idl/codec/wire/exchange.hpp"

namespace telltale {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;

Vehicle Named(const std::string& vehicle_id) {
  Vehicle vehicle = YellowfishVehicle();
  vehicle.vehicle_id = vehicle_id;
  return vehicle;
}

/// Work that goes on until it is let go, and that knows how much was done at once.
class HeldWork {
 public:
  void Do(const std::string& vehicle_id) {
    std::unique_lock lock(mutex_);
    ++inside_;
    most_for_one_ = std::max(most_for_one_, ++inside_for_[vehicle_id]);
    changed_.notify_all();
    changed_.wait_for(lock, 60s, [this] { return free_; });
    --inside_;
    --inside_for_[vehicle_id];
  }

  /// False when fewer than `count` have come within a minute.
  bool AwaitInside(int count) {
    std::unique_lock lock(mutex_);
    return changed_.wait_for(lock, 60s, [&] { return inside_ >= count; });
  }

  void LetGo() {
    const std::lock_guard lock(mutex_);
    free_ = true;
    changed_.notify_all();
  }

  int MostForOneVehicle() {
    const std::lock_guard lock(mutex_);
    return most_for_one_;
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  bool free_ = false;
  int inside_ = 0;
  int most_for_one_ = 0;
  std::map<std::string, int> inside_for_;
};

/// Queues of a fleet of two, and what they answer on the bus.
class Jobs : public ::testing::Test {
 protected:
  using Queue = JobQueue<IdentifyRequest, IdentifyProgress, IdentifyReply>;

  Jobs() {
    // Who first asks makes the logger, where no sanitizer sees: ask before workers do.
    spdlog::default_logger();
    wait_set_.Attach(reader_, [this] { TakeReplies(); });
  }

  std::unique_ptr<Queue> QueueOf(std::size_t workers, std::size_t limit) {
    const auto work = [this](const IdentifyRequest& request, const Progress&) {
      work_.Do(request.vehicle_id);
      return ReplyTo<IdentifyReply>(request, ReplyOutcome::kRefused, "done");
    };
    return std::make_unique<Queue>("identification", fleet_, replies_, workers, limit, work);
  }

  static IdentifyRequest RequestNamed(const std::string& correlation_id,
                                      const std::string& vehicle_id) {
    IdentifyRequest request;
    request.correlation_id = correlation_id;
    request.vehicle_id = vehicle_id;
    return request;
  }

  /// What it answers to this request; asked again, as clients do that have missed an answer.
  std::string ReplyMessageTo(Queue& queue, const IdentifyRequest& request) {
    for (int patience = 0; patience < 200; ++patience) {
      queue.Submit(request);
      if (HasReply(request.correlation_id)) break;
    }
    return messages_[request.correlation_id];
  }

  bool HasReply(const std::string& correlation_id) {
    wait_set_.Wait(100ms);
    return messages_.contains(correlation_id);
  }

  LoopbackDomain domain_;
  Participant participant_{domain_.id()};
  Reader<telltale_wire_IdentifyReply> reader_{participant_};
  WaitSet wait_set_{participant_};
  Fleet fleet_{{Named("one"), Named("two")}, WindowLimits()};
  ReplyPublisher replies_{participant_};
  HeldWork work_;
  std::map<std::string, std::string> messages_;  ///< by correlation id

 private:
  void TakeReplies() {
    reader_.Take([this](const telltale_wire_IdentifyReply& wire) {
      const auto reply = Decode(wire);
      ASSERT_TRUE(reply.has_value());
      messages_[reply->correlation_id] = reply->message;
    });
  }
};

TEST_F(Jobs, WorkOnSeveralVehiclesAtOnce) {
  const auto queue = QueueOf(2, 10);
  queue->Submit(RequestNamed("a", "one"));
  queue->Submit(RequestNamed("b", "two"));
  EXPECT_TRUE(work_.AwaitInside(2));
  work_.LetGo();
  EXPECT_EQ(ReplyMessageTo(*queue, RequestNamed("a", "one")), "done");
  EXPECT_EQ(ReplyMessageTo(*queue, RequestNamed("b", "two")), "done");
}

// The second worker has nothing else to do, and still leaves the vehicle alone.
TEST_F(Jobs, WorkOnOneRequestOfAVehicleAtATime) {
  const auto queue = QueueOf(2, 10);
  queue->Submit(RequestNamed("a", "one"));
  queue->Submit(RequestNamed("b", "one"));
  queue->Submit(RequestNamed("c", "two"));
  EXPECT_TRUE(work_.AwaitInside(2));  // "a", and past "b" the other vehicle's
  work_.LetGo();
  for (const auto& [id, vehicle] : {std::pair("a", "one"), {"b", "one"}, {"c", "two"}}) {
    EXPECT_EQ(ReplyMessageTo(*queue, RequestNamed(id, vehicle)), "done");
  }
  EXPECT_EQ(work_.MostForOneVehicle(), 1);
}

TEST_F(Jobs, RefuseWhatTheyCannotQueue) {
  const auto queue = QueueOf(1, 1);
  queue->Submit(RequestNamed("running", "one"));
  ASSERT_TRUE(work_.AwaitInside(1));
  queue->Submit(RequestNamed("waiting", "two"));
  EXPECT_THAT(ReplyMessageTo(*queue, RequestNamed("too-many", "two")),
              HasSubstr("1 requests for identification are waiting"));
  work_.LetGo();
  EXPECT_EQ(ReplyMessageTo(*queue, RequestNamed("waiting", "two")), "done");
  EXPECT_EQ(ReplyMessageTo(*queue, RequestNamed("another", "two")), "done");
}

TEST_F(Jobs, AnswerWhatStillWaitsWhenTheyEnd) {
  auto queue = QueueOf(1, 10);
  // Once an answer has come through, the next will too.
  ASSERT_THAT(ReplyMessageTo(*queue, RequestNamed("stranger", "three")), HasSubstr("one, two"));
  queue->Submit(RequestNamed("running", "one"));
  ASSERT_TRUE(work_.AwaitInside(1));
  queue->Submit(RequestNamed("waiting", "two"));
  std::thread ending([&] { queue.reset(); });
  work_.LetGo();
  ending.join();
  for (int patience = 0; patience < 200 && !messages_.contains("waiting"); ++patience) {
    wait_set_.Wait(100ms);
  }
  // Either the end or the worker was first; unanswered it does not stay.
  EXPECT_THAT(messages_["waiting"], ::testing::AnyOf(HasSubstr("stopping"), "done"));
}

}  // namespace
}  // namespace telltale
