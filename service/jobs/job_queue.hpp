#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <exception>
#include <functional>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <variant>
#include <vector>

#include <spdlog/spdlog.h>

#include "telltale/client/bus/bus_log.hpp"
#include "telltale/core/identification/progress.hpp"
#include "telltale/service/ingest/fleet.hpp"
#include "telltale/service/jobs/exchange_history.hpp"
#include "telltale/service/jobs/reply.hpp"
#include "telltale/service/jobs/reply_publisher.hpp"

namespace telltale {

/// A bounded queue of requests and the threads that work on them, one request at a time for each
/// vehicle. A request with a known correlation id is not worked on again: the queue sends its
/// progress or its reply again. Every fault of a request ends in its reply. Thread safe.
template <class Request, class Stage, class Reply>
class JobQueue {
 public:
  /// Makes the reply to a request and reports its progress. It runs on a worker, and may throw.
  using Work = std::function<Reply(const Request&, const Progress& progress)>;

  /// `what` names the work in the log and in messages: "identification".
  JobQueue(std::string what, const Fleet& fleet, ReplyPublisher& replies, std::size_t workers,
           std::size_t queue_limit, Work work);
  JobQueue(const JobQueue&) = delete;
  JobQueue& operator=(const JobQueue&) = delete;

  /// Stops the running requests at their next report of progress, and ends the workers. Each
  /// unfinished request gets a failed reply.
  ~JobQueue();

  /// Queues the request, or answers it, and returns at once. Answers go out by ReplyPublisher.
  void Submit(Request request);

 private:
  using Queue = std::deque<Request>;

  /// Ends the work on a request when the daemon stops.
  struct Stopping : std::exception {
    const char* what() const noexcept override { return "the daemon is stopping"; }
  };

  static Reply Failed(const Request& request, const std::string& message) {
    return ReplyTo<Reply>(request, ReplyOutcome::kFailed, message);
  }
  std::optional<Reply> RejectionOf(const Request& request) const;
  void Run();
  std::optional<Request> AwaitNext();
  typename Queue::iterator NextRunnable();
  void Finish(const Request& request, const Reply& reply);
  Reply Execute(const Request& request);
  void Log(const Request& request, const Reply& reply);
  void Report(const Request& request, std::string_view stage, double fraction);

  const std::string what_;
  const Fleet& fleet_;
  ReplyPublisher& replies_;
  const std::size_t queue_limit_;
  const Work work_;

  std::mutex mutex_;  // of what follows
  std::condition_variable changed_;
  Queue queue_;
  ExchangeHistory<Stage, Reply> history_;
  RateLimit log_limit_{200, std::chrono::seconds(10)};
  std::set<std::string> running_vehicles_;
  std::atomic<bool> stopping_ = false;
  std::vector<std::thread> workers_;
};

template <class Request, class Stage, class Reply>
JobQueue<Request, Stage, Reply>::JobQueue(std::string what, const Fleet& fleet,
                                          ReplyPublisher& replies, std::size_t workers,
                                          std::size_t queue_limit, Work work)
    : what_(std::move(what)),
      fleet_(fleet),
      replies_(replies),
      queue_limit_(queue_limit),
      work_(std::move(work)) {
  for (std::size_t i = 0; i < workers; ++i) workers_.emplace_back([this] { Run(); });
}

template <class Request, class Stage, class Reply>
JobQueue<Request, Stage, Reply>::~JobQueue() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  changed_.notify_all();
  for (std::thread& worker : workers_) worker.join();
  for (const Request& request : queue_) replies_.Send(Failed(request, Stopping().what()));
}

template <class Request, class Stage, class Reply>
void JobQueue<Request, Stage, Reply>::Submit(Request request) {
  std::unique_lock lock(mutex_);
  if (const auto answer = history_.Find(request.correlation_id)) {
    lock.unlock();
    return std::visit([this](const auto& known) { replies_.Send(known); }, *answer);
  }
  if (const auto rejection = RejectionOf(request)) {
    lock.unlock();
    return replies_.Send(*rejection);
  }
  const Stage stage{{request.correlation_id, request.vehicle_id, "queued", 0.0}};
  history_.Begin(stage);
  queue_.push_back(std::move(request));
  lock.unlock();
  changed_.notify_one();
  replies_.Send(stage);
}

/// Why the queue cannot take a request; the caller holds mutex_.
template <class Request, class Stage, class Reply>
std::optional<Reply> JobQueue<Request, Stage, Reply>::RejectionOf(const Request& request) const {
  if (fleet_.Find(request.vehicle_id) == nullptr) {
    return Failed(request, "vehicle '" + request.vehicle_id +
                               "' is not served here; served: " + fleet_.Served());
  }
  if (queue_.size() >= queue_limit_) {
    return Failed(request, std::to_string(queue_limit_) + " requests for " + what_ +
                               " are waiting already; ask again later");
  }
  return std::nullopt;
}

template <class Request, class Stage, class Reply>
void JobQueue<Request, Stage, Reply>::Run() {
  while (const auto request = AwaitNext()) {
    const Reply reply = Execute(*request);
    Finish(*request, reply);
    replies_.Send(reply);
  }
}

/// Takes the oldest request whose vehicle is free off the queue; nothing when the daemon stops.
template <class Request, class Stage, class Reply>
std::optional<Request> JobQueue<Request, Stage, Reply>::AwaitNext() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return stopping_ || NextRunnable() != queue_.end(); });
  if (stopping_) return std::nullopt;
  const auto next = NextRunnable();
  Request request = std::move(*next);
  queue_.erase(next);
  running_vehicles_.insert(request.vehicle_id);
  return request;
}

template <class Request, class Stage, class Reply>
void JobQueue<Request, Stage, Reply>::Finish(const Request& request, const Reply& reply) {
  {
    const std::lock_guard lock(mutex_);
    running_vehicles_.erase(request.vehicle_id);
    history_.Finish(reply);
  }
  changed_.notify_all();
}

template <class Request, class Stage, class Reply>
auto JobQueue<Request, Stage, Reply>::NextRunnable() -> typename Queue::iterator {
  return std::ranges::find_if(queue_, [this](const Request& request) {
    return !running_vehicles_.contains(request.vehicle_id);
  });
}

template <class Request, class Stage, class Reply>
Reply JobQueue<Request, Stage, Reply>::Execute(const Request& request) {
  using Clock = std::chrono::steady_clock;
  const auto start = Clock::now();
  Reply reply;
  try {
    reply = work_(request, [&](std::string_view stage, double fraction) {
      Report(request, stage, fraction);
    });
  } catch (const std::exception& error) {
    reply = Failed(request, error.what());
  }
  reply.elapsed_s = std::chrono::duration<double>(Clock::now() - start).count();
  Log(request, reply);
  return reply;
}

/// With each reason. A flood of requests writes a bounded number of lines.
template <class Request, class Stage, class Reply>
void JobQueue<Request, Stage, Reply>::Log(const Request& request, const Reply& reply) {
  std::optional<std::uint64_t> not_shown;
  {
    const std::lock_guard lock(mutex_);
    not_shown = log_limit_.Admit(std::chrono::steady_clock::now());
  }
  if (!not_shown) return;
  std::string reasons = reply.message;
  for (const Refusal& refusal : reply.refusals) {
    if (!reasons.empty()) reasons += "; ";
    reasons += refusal.subject + ": " + refusal.reason;
  }
  if (*not_shown > 0) reasons += " (" + std::to_string(*not_shown) + " more not shown)";
  const auto level = reply.outcome == ReplyOutcome::kPublished ? spdlog::level::info
                     : reply.outcome == ReplyOutcome::kRefused ? spdlog::level::warn
                                                               : spdlog::level::err;
  spdlog::log(level, "{} of {} for {}: {} in {:.3f} s{}{}", what_, request.vehicle_id,
              request.correlation_id, Name(reply.outcome), reply.elapsed_s,
              reasons.empty() ? "" : ": ", reasons);
}

template <class Request, class Stage, class Reply>
void JobQueue<Request, Stage, Reply>::Report(const Request& request, std::string_view stage,
                                             double fraction) {
  if (stopping_) throw Stopping();
  std::optional<Stage> progress;
  {
    const std::lock_guard lock(mutex_);
    progress = history_.Advance(request.correlation_id, stage, fraction);
  }
  if (progress) replies_.Send(*progress);
}

}  // namespace telltale
