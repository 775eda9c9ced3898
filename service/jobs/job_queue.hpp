#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <exception>
#include <functional>
#include <list>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <variant>
#include <vector>

#include "telltale/client/bus/bus_log.hpp"
#include "telltale/service/ingest/fleet.hpp"
#include "telltale/service/jobs/computation.hpp"
#include "telltale/service/jobs/exchange_history.hpp"
#include "telltale/service/jobs/job.hpp"
#include "telltale/service/jobs/queue_activity.hpp"
#include "telltale/service/jobs/reply.hpp"
#include "telltale/service/jobs/reply_publisher.hpp"
#include "telltale/service/jobs/request_journal.hpp"
#include "telltale/service/jobs/urgency.hpp"

namespace telltale {

/// A bounded queue of requests and the threads that work on them.
/// - Each urgency has workers of its own, so none waits until no more urgent request is left. Of
///   each urgency a vehicle has one request worked on at a time, and the vehicle whose last one
///   began longest ago comes first: it waits for one of each other vehicle at most.
/// - A worker that runs out of requests gives back the memory that its work has freed.
/// - A request with a known correlation id is not worked on again: the queue sends its progress or
///   its reply again. A request that asks for the same as one that waits, or that has been worked
///   on for less than 5 s and is as urgent, joins it, and both get its reply.
/// - A request that was cancelled, or whose deadline has passed, is dropped unless others have
///   joined it. Work under way ends at its next report of progress.
/// - A request is dropped likewise once its client has been gone from the bus for kClientPatience.
///   A client that asks again, by whatever writer, is there.
/// - A full queue answers at once, and says when to ask again. So it answers a client that has a
///   quarter of the queue's limit of requests without an answer. So does a queue whose journal
///   cannot be reached, also where that shows in the midst of the work.
/// - With a journal, a request is on disk before its client hears of it, but for a reply, and until
///   it is answered.
/// Every fault of a request ends in its reply. Thread safe.
template <class Request, class Stage, class Reply>
class JobQueue {
 public:
  /// Makes the reply to a request, and computes by `computation`. It runs on a worker, and may
  /// throw.
  using Work = std::function<Reply(const Request&, const Computation& computation)>;
  using Answer = std::function<void(const Reply&)>;

  /// `what` names the work in the log and in messages: "identification". The journal outlives the
  /// queue.
  JobQueue(std::string what, const Fleet& fleet, ReplyPublisher& replies, const Workers& workers,
           std::size_t queue_limit, Work work, RequestJournal* journal = nullptr);
  JobQueue(const JobQueue&) = delete;
  JobQueue& operator=(const JobQueue&) = delete;

  /// Stops the running requests at their next report of progress, and ends the workers. Each
  /// unfinished request gets a failed reply.
  ~JobQueue();

  /// Queues the request, or answers it, and returns at once. Answers go out by ReplyPublisher, or
  /// to `answer`, which runs on a worker or on the calling thread.
  void Submit(Request request, Urgency urgency = Urgency::kInteractive, Answer answer = {},
              WriterHandle client = kNoClient);

  /// Answers a request as failed, for this reason, without working on it.
  void GiveUp(const Request& request, const std::string& reason);

  /// Answers the unfinished request with this correlation id as failed. False where there is none.
  bool Cancel(const std::string& correlation_id);

  /// `connected`: the clients whose writers the bus knows now; to be told once a second or so.
  void NoteClients(const std::set<WriterHandle>& connected);

  QueueActivity Activity() const;

 private:
  using Clock = std::chrono::steady_clock;
  using Job = telltale::Job<Request, Reply>;
  using Asker = telltale::Asker<Reply>;
  using Jobs = std::list<std::shared_ptr<Job>>;
  using Outbox = std::vector<std::pair<Asker, Reply>>;

  static constexpr std::chrono::seconds kJoinedWithin{5};
  static constexpr double kAskAgainS = 0.1;
  static constexpr double kUnavailableS = 2.0;  ///< a lost connection is tried once a second

  /// Ends the work on a request when the daemon stops.
  struct Stopping : std::exception {
    const char* what() const noexcept override { return "the daemon is stopping"; }
  };
  /// Ends the work on a request that nobody waits for.
  struct Abandoned : std::exception {
    const char* what() const noexcept override { return "nobody waits for it any more"; }
  };

  static Reply Failed(const Request& request, const std::string& message) {
    return ReplyTo<Reply>(request, ReplyOutcome::kFailed, message);
  }
  static Reply Busy(const Request& request, const std::string& why, double retry_after_s) {
    Reply reply = Failed(
        request, why + "; ask again in " + std::to_string(std::lround(retry_after_s)) + " s");
    reply.retry_after_s = retry_after_s;
    return reply;
  }
  static std::optional<Clock::time_point> DeadlineOf(const Request& request);
  bool Prolong(const Request& request, WriterHandle client);
  std::optional<Reply> RejectionOf(const Request& request, Urgency urgency);
  std::optional<Reply> RejectionByShare(const Request& request, Urgency urgency,
                                        WriterHandle client);
  std::size_t UnansweredOf(WriterHandle client) const;
  double RetryAfterS(Urgency urgency) const;
  std::size_t Waiting() const;
  Clock::duration LongestSilence() const;
  std::shared_ptr<Job> JobLike(const Request& request, Urgency urgency) const;
  void Queue(Request request, Urgency urgency, Asker asker);
  void Run(Urgency urgency);
  bool HasWorkFor(Urgency urgency) const;
  void CountAttempts(const std::shared_ptr<Job>& job);
  std::shared_ptr<Job> AwaitNext(Urgency urgency);
  std::shared_ptr<Job> NextRunnable(Urgency urgency) const;
  std::optional<Clock::time_point> EarliestDeadline() const;
  Outbox Expire();
  static void Dismiss(const Job& job, std::vector<Asker> askers, const std::string& why,
                      Outbox& outbox);
  void Send(const Outbox& outbox);
  void Finish(const std::shared_ptr<Job>& job, Reply reply);
  Reply Execute(const std::shared_ptr<Job>& job);
  void Log(const Request& request, const Reply& reply, std::size_t askers);
  void Report(const std::shared_ptr<Job>& job, std::string_view stage, double fraction);

  const std::string what_;
  const Fleet& fleet_;
  ReplyPublisher& replies_;
  const Workers worker_counts_;
  const std::size_t queue_limit_;
  const Work work_;
  RequestJournal* const journal_;  ///< null: requests die with the process

  mutable std::mutex mutex_;  // of what follows
  std::condition_variable changed_;
  Jobs jobs_;  ///< that wait and that run, oldest first
  std::uint64_t submitted_ = 0;
  std::uint64_t begun_ = 0;
  std::uint64_t shed_ = 0;
  ExchangeHistory<Stage, Reply> history_;
  RateLimit log_limit_{200, std::chrono::seconds(10)};
  std::set<std::pair<Urgency, std::string>> running_vehicles_;
  /// `begun_` at the last job of this urgency and vehicle.
  std::map<std::pair<Urgency, std::string>, std::uint64_t> last_begun_;
  double mean_duration_s_ = 1.0;  ///< of the latest jobs
  std::atomic<bool> stopping_ = false;
  std::vector<std::thread> workers_;
};

using IdentificationQueue = JobQueue<IdentifyRequest, IdentifyProgress, IdentifyReply>;
using DiagnosisQueue = JobQueue<DiagnoseRequest, DiagnoseProgress, DiagnoseReply>;

// They are compiled once, in job_queue.cpp.
extern template class JobQueue<IdentifyRequest, IdentifyProgress, IdentifyReply>;
extern template class JobQueue<DiagnoseRequest, DiagnoseProgress, DiagnoseReply>;

}  // namespace telltale
