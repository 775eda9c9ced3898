#include "telltale/service/jobs/job_queue.hpp"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <fstream>
#include <future>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <sstream>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <SQLiteCpp/SQLiteCpp.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <spdlog/sinks/ostream_sink.h>
#include <spdlog/spdlog.h>

#include "support/loopback_domain.hpp"
#include "support/temporary_folder.hpp"
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

std::size_t ResidentBytes() {
  std::size_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages >> pages;  // the second field
  return pages * static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
}

/// Work that goes on until it is let go, and that knows what was done, and how much at once.
class HeldWork {
 public:
  void Do(const std::string& vehicle_id, const Progress& progress) {
    std::unique_lock lock(mutex_);
    begun_.push_back(vehicle_id);
    ++inside_;
    most_for_one_ = std::max(most_for_one_, ++inside_for_[vehicle_id]);
    changed_.notify_all();
    try {
      while (!changed_.wait_for(lock, 10ms, [this] { return free_; })) {
        progress("held", 0.5);
        ++reports_;
        changed_.notify_all();
      }
    } catch (...) {
      Leave(vehicle_id);
      throw;
    }
    Leave(vehicle_id);
  }

  /// False when fewer than `count` have come within a minute.
  bool AwaitInside(int count) {
    std::unique_lock lock(mutex_);
    return changed_.wait_for(lock, 60s, [&] { return inside_ >= count; });
  }

  /// False where the work has not reported its progress within a minute.
  bool AwaitReport() {
    std::unique_lock lock(mutex_);
    return changed_.wait_for(lock, 60s, [&] { return reports_ > 0; });
  }

  bool AwaitNobodyInside() {
    std::unique_lock lock(mutex_);
    return changed_.wait_for(lock, 60s, [&] { return inside_ == 0; });
  }

  /// The vehicles worked on, in the order in which the work began.
  std::vector<std::string> Begun() {
    const std::lock_guard lock(mutex_);
    return begun_;
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
  void Leave(const std::string& vehicle_id) {
    --inside_;
    --inside_for_[vehicle_id];
    changed_.notify_all();
  }

  std::mutex mutex_;
  std::condition_variable changed_;
  bool free_ = false;
  std::vector<std::string> begun_;
  int inside_ = 0;
  int reports_ = 0;
  int most_for_one_ = 0;
  std::map<std::string, int> inside_for_;
};

/// Queues of a fleet of two, and what they answer on the bus.
class Jobs : public ::testing::Test {
 protected:
  Jobs() {
    // Who first asks makes the logger, where no sanitizer sees: ask before workers do.
    spdlog::default_logger();
    wait_set_.Attach(reader_, [this] { TakeReplies(); });
  }

  std::unique_ptr<IdentificationQueue> QueueOf(const Workers& workers, std::size_t limit,
                                               RequestJournal* journal = nullptr) {
    const auto work = [this](const IdentifyRequest& request, const Computation& computation) {
      computation([&](const Progress& progress) { work_.Do(request.vehicle_id, progress); });
      return ReplyTo<IdentifyReply>(request, ReplyOutcome::kRefused, "done");
    };
    return std::make_unique<IdentificationQueue>("identification", fleet_, replies_, workers, limit,
                                                 work, journal);
  }

  /// Asks for something of its own, unless the seeds are alike.
  static IdentifyRequest RequestNamed(const std::string& correlation_id,
                                      const std::string& vehicle_id,
                                      std::optional<std::uint64_t> seed = std::nullopt) {
    IdentifyRequest request;
    request.correlation_id = correlation_id;
    request.vehicle_id = vehicle_id;
    request.seed = seed.value_or(std::hash<std::string>()(correlation_id));
    return request;
  }

  /// What it answers to this request; asked again, as clients do that have missed an answer.
  std::string ReplyMessageTo(IdentificationQueue& queue, const IdentifyRequest& request) {
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
  Role role_{std::nullopt};
  ReplyPublisher replies_{participant_, role_};
  HeldWork work_;
  std::map<std::string, std::string> messages_;  ///< by correlation id
  std::map<std::string, double> retry_after_s_;  ///< likewise

 private:
  void TakeReplies() {
    reader_.Take([this](const telltale_wire_IdentifyReply& wire) {
      const auto reply = Decode(wire);
      ASSERT_TRUE(reply.has_value());
      messages_[reply->correlation_id] = reply->message;
      retry_after_s_[reply->correlation_id] = reply->retry_after_s;
    });
  }
};

// What a client has heard of is not lost where the daemon is killed at once.
TEST_F(Jobs, TellNobodyOfARequestBeforeItIsOnDisk) {
  Reader<telltale_wire_IdentifyProgress> progress(participant_);
  std::vector<std::string> heard;
  wait_set_.Attach(progress, [&] {
    progress.Take([&](const auto& wire) { heard.emplace_back(wire.correlation_id); });
  });
  const auto await = [&](const std::string& correlation_id) {
    for (int patience = 0; patience < 600; ++patience) {
      if (std::ranges::find(heard, correlation_id) != heard.end()) return true;
      wait_set_.Wait(100ms);
    }
    return false;
  };
  const TemporaryFolder folder;
  RequestJournal journal(Storage(folder.Path()));
  journal.TakeUnanswered();
  const auto queue = QueueOf({.interactive = 1}, 10, &journal);
  const auto forgetful = QueueOf({.interactive = 1}, 10);
  SQLite::Database other(folder.Path() / "requests.sqlite", SQLite::OPEN_READWRITE);
  other.exec("BEGIN IMMEDIATE");  // the journal waits for it
  queue->Submit(RequestNamed("kept", "one"));
  ASSERT_TRUE(work_.AwaitReport());
  queue->Submit(RequestNamed("kept", "one"));
  forgetful->Submit(RequestNamed("other", "two"));  // told after whatever was told of the first
  EXPECT_TRUE(await("other"));
  EXPECT_EQ(std::ranges::count(heard, "kept"), 0);
  other.exec("ROLLBACK");
  EXPECT_TRUE(await("kept"));
  wait_set_.Detach(progress);  // each progress would end a wait for the reply
  work_.LetGo();
  EXPECT_EQ(ReplyMessageTo(*queue, RequestNamed("kept", "one")), "done");
}

TEST_F(Jobs, WorkOnSeveralVehiclesAtOnce) {
  const auto queue = QueueOf({.interactive = 2}, 10);
  queue->Submit(RequestNamed("a", "one"));
  queue->Submit(RequestNamed("b", "two"));
  EXPECT_TRUE(work_.AwaitInside(2));
  work_.LetGo();
  EXPECT_EQ(ReplyMessageTo(*queue, RequestNamed("a", "one")), "done");
  EXPECT_EQ(ReplyMessageTo(*queue, RequestNamed("b", "two")), "done");
}

// The second worker has nothing else to do, and still leaves the vehicle alone.
TEST_F(Jobs, WorkOnOneRequestOfAVehicleAtATime) {
  const auto queue = QueueOf({.interactive = 2}, 10);
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
  const auto queue = QueueOf({.interactive = 1}, 1);
  queue->Submit(RequestNamed("running", "one"));
  ASSERT_TRUE(work_.AwaitInside(1));
  queue->Submit(RequestNamed("waiting", "two"));
  EXPECT_THAT(ReplyMessageTo(*queue, RequestNamed("too-many", "two")),
              HasSubstr("1 requests for identification are waiting"));
  EXPECT_GE(retry_after_s_["too-many"], 1.0);
  work_.LetGo();
  EXPECT_EQ(ReplyMessageTo(*queue, RequestNamed("waiting", "two")), "done");
  EXPECT_EQ(ReplyMessageTo(*queue, RequestNamed("another", "two")), "done");
}

TEST_F(Jobs, AnswerWhatStillWaitsWhenTheyEnd) {
  auto queue = QueueOf({.interactive = 1}, 10);
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

TEST_F(Jobs, LetNobodyWaitForACoverageCheck) {
  const auto queue = QueueOf({.interactive = 1, .refresh = 1, .background = 1}, 10);
  queue->Submit(RequestNamed("check", "one"), Urgency::kBackground);
  queue->Submit(RequestNamed("another-check", "two"), Urgency::kBackground);
  ASSERT_TRUE(work_.AwaitInside(1));
  queue->Submit(RequestNamed("refresh", "two"), Urgency::kRefresh);
  ASSERT_TRUE(work_.AwaitInside(2));
  queue->Submit(RequestNamed("plain", "one"));
  EXPECT_TRUE(work_.AwaitInside(3));
  work_.LetGo();
  for (const auto& [id, vehicle] : {std::pair("check", "one"), {"plain", "one"}}) {
    EXPECT_EQ(ReplyMessageTo(*queue, RequestNamed(id, vehicle)), "done");
  }
}

// It would have to wait for as long as that takes, which leaves the processors to all others.
TEST_F(Jobs, DoNotLetARequestJoinWorkThatIsLessUrgent) {
  const auto queue = QueueOf({.interactive = 1, .refresh = 1}, 10);
  queue->Submit(RequestNamed("refresh", "one", 7), Urgency::kRefresh);
  ASSERT_TRUE(work_.AwaitInside(1));
  queue->Submit(RequestNamed("plain", "one", 7));
  EXPECT_TRUE(work_.AwaitInside(2));
  work_.LetGo();
  EXPECT_EQ(ReplyMessageTo(*queue, RequestNamed("plain", "one", 7)), "done");
  EXPECT_EQ(ReplyMessageTo(*queue, RequestNamed("refresh", "one", 7)), "done");
}

TEST_F(Jobs, SayHowLongTheirWorkHasReportedNothing) {
  using Clock = std::chrono::steady_clock;
  std::promise<void> may_report;
  std::promise<void> reported;
  std::promise<void> may_end;
  IdentificationQueue queue("identification", fleet_, replies_, {.interactive = 1}, 10,
                            [&](const IdentifyRequest& request, const Computation& computation) {
                              may_report.get_future().wait();
                              computation.Report("fitting", 0.5);
                              reported.set_value();
                              may_end.get_future().wait();
                              return ReplyTo<IdentifyReply>(request, ReplyOutcome::kRefused,
                                                            "done");
                            });
  EXPECT_EQ(queue.Activity().silence, 0s);
  queue.Submit(RequestNamed("a", "one"));
  while (queue.Activity().silence < 50ms) std::this_thread::yield();
  const auto before_report = Clock::now();
  may_report.set_value();
  reported.get_future().wait();
  const auto silence = queue.Activity().silence;
  EXPECT_LE(silence, Clock::now() - before_report);
  may_end.set_value();
  while (queue.Activity().running > 0) std::this_thread::yield();
  EXPECT_EQ(queue.Activity().silence, 0s);
}

// A worker that gave way itself would hold the queue while it gets no processor, and whoever
// submits a request would wait for it.
TEST_F(Jobs, FinishACoverageCheckWithoutGivingWay) {
  const auto nice = [] { return getpriority(PRIO_PROCESS, static_cast<id_t>(gettid())); };
  std::promise<int> finished_at;
  const auto queue = QueueOf({.background = 1}, 10);
  queue->Submit(RequestNamed("check", "one"), Urgency::kBackground,
                [&](const IdentifyReply&) { finished_at.set_value(nice()); });
  work_.LetGo();
  EXPECT_EQ(finished_at.get_future().get(), nice());
}

TEST_F(Jobs, WorkOnceForAllWhoAskTheSame) {
  const auto queue = QueueOf({.interactive = 1}, 10);
  queue->Submit(RequestNamed("held", "one"));
  ASSERT_TRUE(work_.AwaitInside(1));
  for (int i = 0; i < 60; ++i) queue->Submit(RequestNamed("ask-" + std::to_string(i), "two", 7));
  work_.LetGo();
  for (int i = 0; i < 60; ++i) {
    EXPECT_EQ(ReplyMessageTo(*queue, RequestNamed("ask-" + std::to_string(i), "two", 7)), "done");
  }
  EXPECT_THAT(work_.Begun(), ::testing::ElementsAre("one", "two"));
}

TEST_F(Jobs, TakeVehiclesInTurn) {
  const auto queue = QueueOf({.interactive = 1}, 10);
  queue->Submit(RequestNamed("a", "one"));
  ASSERT_TRUE(work_.AwaitInside(1));
  for (const char* id : {"b", "c", "d"}) queue->Submit(RequestNamed(id, "one"));
  queue->Submit(RequestNamed("e", "two"));
  work_.LetGo();
  for (const auto& [id, vehicle] : {std::pair("d", "one"), {"e", "two"}}) {
    EXPECT_EQ(ReplyMessageTo(*queue, RequestNamed(id, vehicle)), "done");
  }
  EXPECT_THAT(work_.Begun(), ::testing::ElementsAre("one", "two", "one", "one", "one"));
}

// However often somebody identifies it meanwhile.
TEST_F(Jobs, RefreshVehiclesInTurn) {
  const auto queue = QueueOf({.interactive = 1, .refresh = 1}, 10);
  queue->Submit(RequestNamed("a", "two"), Urgency::kRefresh);
  ASSERT_TRUE(work_.AwaitInside(1));
  queue->Submit(RequestNamed("plain", "one"));
  ASSERT_TRUE(work_.AwaitInside(2));
  queue->Submit(RequestNamed("b", "two"), Urgency::kRefresh);
  queue->Submit(RequestNamed("c", "one"), Urgency::kRefresh);
  work_.LetGo();
  for (const auto& [id, vehicle] : {std::pair("b", "two"), {"c", "one"}}) {
    EXPECT_EQ(ReplyMessageTo(*queue, RequestNamed(id, vehicle)), "done");
  }
  EXPECT_THAT(work_.Begun(), ::testing::ElementsAre("two", "one", "one", "two"));
}

TEST_F(Jobs, DropWhatNobodyWaitsForAnyMore) {
  const auto queue = QueueOf({.interactive = 1}, 10);
  IdentifyRequest patient = RequestNamed("patient", "one", 1);
  queue->Submit(patient);
  ASSERT_TRUE(work_.AwaitInside(1));
  IdentifyRequest hasty = RequestNamed("hasty", "two");
  hasty.deadline_s = 0.05;
  queue->Submit(hasty);
  for (int patience = 0; patience < 200 && !HasReply("hasty"); ++patience) {
  }
  EXPECT_THAT(messages_["hasty"], HasSubstr("deadline has passed"));
  // Work under way ends too.
  EXPECT_TRUE(queue->Cancel("patient"));
  EXPECT_TRUE(work_.AwaitNobodyInside());
  EXPECT_THAT(work_.Begun(), ::testing::ElementsAre("one"));
  EXPECT_THAT(ReplyMessageTo(*queue, patient), HasSubstr("cancelled"));
}

TEST_F(Jobs, GoOnForThoseWhoStillWait) {
  const auto queue = QueueOf({.interactive = 1}, 10);
  queue->Submit(RequestNamed("first", "one", 1));
  ASSERT_TRUE(work_.AwaitInside(1));
  queue->Submit(RequestNamed("second", "one", 1));
  EXPECT_TRUE(queue->Cancel("first"));
  EXPECT_FALSE(queue->Cancel("nobody"));
  work_.LetGo();
  EXPECT_EQ(ReplyMessageTo(*queue, RequestNamed("second", "one", 1)), "done");
  EXPECT_THAT(work_.Begun(), ::testing::ElementsAre("one"));
}

// The limit is 8: a client may have two requests without an answer.
TEST_F(Jobs, KeepOneClientFromFillingTheQueue) {
  constexpr WriterHandle kFlooding = 7;
  constexpr WriterHandle kOther = 8;
  const auto queue = QueueOf({.interactive = 1}, 8);
  queue->Submit(RequestNamed("running", "one"), Urgency::kInteractive, {}, kFlooding);
  ASSERT_TRUE(work_.AwaitInside(1));
  queue->Submit(RequestNamed("waiting", "one"), Urgency::kInteractive, {}, kFlooding);
  queue->Submit(RequestNamed("beyond", "one"), Urgency::kInteractive, {}, kFlooding);
  // Also what would join another request.
  queue->Submit(RequestNamed("alike", "one", 1), Urgency::kInteractive, {}, kOther);
  queue->Submit(RequestNamed("joining", "one", 1), Urgency::kInteractive, {}, kFlooding);
  EXPECT_EQ(queue->Activity().shed, 2u);
  EXPECT_EQ(queue->Activity().waiting, 2u);
  EXPECT_THAT(ReplyMessageTo(*queue, RequestNamed("stranger", "three")), HasSubstr("one, two"));
  for (const char* id : {"beyond", "joining"}) {
    for (int patience = 0; patience < 200 && !HasReply(id); ++patience) {
    }
    EXPECT_THAT(messages_[id], HasSubstr("2 requests of this client"));
    EXPECT_GT(retry_after_s_[id], 0.0);
  }
  work_.LetGo();
  EXPECT_EQ(ReplyMessageTo(*queue, RequestNamed("alike", "one", 1)), "done");
  queue->Submit(RequestNamed("later", "one"), Urgency::kInteractive, {}, kFlooding);
  EXPECT_EQ(ReplyMessageTo(*queue, RequestNamed("later", "one")), "done");
}

// Blocks that stay, as a model does, lie between those that are freed, so that free() returns none.
// The daemon's other return of memory comes once a minute and is not at work here.
TEST_F(Jobs, GiveBackTheMemoryThatTheirWorkHasFreed) {
#ifdef TELLTALE_SANITIZED
  GTEST_SKIP() << "a sanitizer has a heap of its own, which keeps what is freed";
#endif
  constexpr std::size_t kBlockBytes = 4096;
  constexpr std::size_t kBlocks = 16384;
  constexpr std::size_t kStays = 64;  // one of so many
  std::vector<std::vector<char>> stay;
  std::size_t most_bytes = 0;
  IdentificationQueue queue("identification", fleet_, replies_, {.interactive = 1}, 10,
                            [&](const IdentifyRequest& request, const Computation&) {
                              std::vector<std::vector<char>> blocks;
                              for (std::size_t i = 0; i < kBlocks; ++i) {
                                blocks.emplace_back(kBlockBytes, 'x');
                              }
                              most_bytes = ResidentBytes();
                              for (std::size_t i = 0; i < kBlocks; i += kStays) {
                                stay.push_back(std::move(blocks[i]));
                              }
                              return ReplyTo<IdentifyReply>(request, ReplyOutcome::kRefused,
                                                            "done");
                            });
  std::promise<void> done;
  queue.Submit(RequestNamed("a", "one"), Urgency::kInteractive,
               [&](const IdentifyReply&) { done.set_value(); });
  done.get_future().wait();
  const auto until = std::chrono::steady_clock::now() + 60s;
  const auto has_given_back = [&] {
    return ResidentBytes() + kBlocks * kBlockBytes / 2 < most_bytes;
  };
  while (!has_given_back() && std::chrono::steady_clock::now() < until) std::this_thread::yield();
  EXPECT_TRUE(has_given_back()) << ResidentBytes() << " of " << most_bytes;
}

TEST_F(Jobs, WriteABoundedLogUnderAFlood) {
  std::ostringstream log;
  const auto before = spdlog::default_logger();
  spdlog::set_default_logger(std::make_shared<spdlog::logger>(
      "flood", std::make_shared<spdlog::sinks::ostream_sink_mt>(log)));
  {
    const auto queue = QueueOf({.interactive = 1}, 10);
    for (int i = 0; i < 3000; ++i) {
      queue->Submit(RequestNamed("flood-" + std::to_string(i), "stranger"));
    }
  }
  spdlog::set_default_logger(before);
  EXPECT_THAT(log.str(), HasSubstr("'stranger' is not served here"));
  EXPECT_LT(log.str().size(), 100'000u);
}

}  // namespace
}  // namespace telltale
