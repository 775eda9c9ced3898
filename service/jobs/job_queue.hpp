#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <exception>
#include <functional>
#include <map>
#include <mutex>
#include <set>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <spdlog/spdlog.h>

#include "telltale/core/identification/progress.hpp"
#include "telltale/idl/codec/messages/exchange.hpp"
#include "telltale/service/ingest/fleet.hpp"
#include "telltale/service/jobs/reply_publisher.hpp"

namespace telltale {

/// A reply to this request, so far without an answer in it.
template <class Reply, class Request>
Reply ReplyTo(const Request& request, ReplyOutcome outcome, const std::string& message = {}) {
  Reply reply;
  reply.correlation_id = request.correlation_id;
  reply.vehicle_id = request.vehicle_id;
  reply.outcome = outcome;
  reply.message = message;
  return reply;
}

/// Works on request, on worker threads. A bounded queue; one request at a time for each vehicle;
/// every correlation id is worked on once: asked again it is told how far the work is, or given its
/// reply again. Whatever goes wrong with one request ends in its reply.
template <class Request, class Stage, class Reply>
class JobQueue {
 public:
  /// ReplyPublisher a request, telling `progress` how far it is; runs on a worker, and may throw.
  using Work = std::function<Reply(const Request&, const Progress& progress)>;

  /// `what` is what is done to a vehicle, for the log and messages: "identification".
  JobQueue(std::string what, const Fleet& fleet, ReplyPublisher& replies, std::size_t workers,
           std::size_t queue_limit, Work work);
  JobQueue(const JobQueue&) = delete;
  JobQueue& operator=(const JobQueue&) = delete;
  ~JobQueue();  ///< breaks off what is running and ends the workers

  /// Takes a request in and returns; the answer goes out through ReplyPublisher.
  void Submit(Request request);

 private:
  using Queue = std::deque<Request>;

  /// Unwinds the work when the daemon stops.
  struct Stopping : std::exception {
    const char* what() const noexcept override { return "the daemon is stopping"; }
  };

  static Reply Failed(const Request& request, const std::string& message) {
    return ReplyTo<Reply>(request, ReplyOutcome::kFailed, message);
  }
  void Run();
  typename Queue::iterator NextRunnable();
  Reply Execute(const Request& request);
  void Report(const Request& request, std::string_view stage, double fraction);
  void Remember(const Reply& reply);

  const std::string what_;
  const Fleet& fleet_;
  ReplyPublisher& replies_;
  const std::size_t queue_limit_;
  const Work work_;

  std::mutex mutex_;
  std::condition_variable changed_;
  Queue queue_;
  std::map<std::string, Stage> unfinished_;  ///< by correlation id, queued or running
  std::set<std::string> running_vehicles_;
  std::map<std::string, Reply> finished_;  ///< by correlation id, the latest few
  std::deque<std::string> finished_order_;
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
  if (const auto done = finished_.find(request.correlation_id); done != finished_.end()) {
    const Reply reply = done->second;
    lock.unlock();
    return replies_.Send(reply);
  }
  if (const auto known = unfinished_.find(request.correlation_id); known != unfinished_.end()) {
    const Stage stage = known->second;
    lock.unlock();
    return replies_.Send(stage);
  }
  if (fleet_.Find(request.vehicle_id) == nullptr) {
    lock.unlock();
    return replies_.Send(Failed(request, "vehicle '" + request.vehicle_id +
                                             "' is not served here; served: " + fleet_.Served()));
  }
  if (queue_.size() >= queue_limit_) {
    lock.unlock();
    return replies_.Send(Failed(
        request, std::to_string(queue_limit_) + ' ' + what_ + "s are waiting already; ask later"));
  }
  const Stage stage{{request.correlation_id, request.vehicle_id, "queued", 0.0}};
  unfinished_.emplace(request.correlation_id, stage);
  queue_.push_back(std::move(request));
  lock.unlock();
  changed_.notify_one();
  replies_.Send(stage);
}

template <class Request, class Stage, class Reply>
void JobQueue<Request, Stage, Reply>::Run() {
  std::unique_lock lock(mutex_);
  for (;;) {
    changed_.wait(lock, [this] { return stopping_ || NextRunnable() != queue_.end(); });
    if (stopping_) return;
    const auto next = NextRunnable();
    const Request request = std::move(*next);
    queue_.erase(next);
    running_vehicles_.insert(request.vehicle_id);
    lock.unlock();
    const Reply reply = Execute(request);
    lock.lock();
    running_vehicles_.erase(request.vehicle_id);
    unfinished_.erase(request.correlation_id);
    Remember(reply);
    lock.unlock();
    changed_.notify_all();
    replies_.Send(reply);
    lock.lock();
  }
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
  spdlog::info("{} of {} for {}: {} in {:.3f} s {}", what_, request.vehicle_id,
               request.correlation_id, Name(reply.outcome), reply.elapsed_s, reply.message);
  return reply;
}

template <class Request, class Stage, class Reply>
void JobQueue<Request, Stage, Reply>::Report(const Request& request, std::string_view stage,
                                             double fraction) {
  constexpr double kReportedStep = 0.02;
  if (stopping_) throw Stopping();
  Stage told;
  {
    const std::lock_guard lock(mutex_);
    Stage& last = unfinished_.find(request.correlation_id)->second;
    if (last.stage == stage && fraction - last.fraction < kReportedStep) return;
    last.stage = stage;
    last.fraction = std::clamp(fraction, 0.0, 1.0);
    told = last;
  }
  replies_.Send(told);
}

template <class Request, class Stage, class Reply>
void JobQueue<Request, Stage, Reply>::Remember(const Reply& reply) {
  // Replies are some ten kilobytes; whoever asks again does so within seconds.
  constexpr std::size_t kRememberedReplies = 256;
  finished_.insert_or_assign(reply.correlation_id, reply);
  finished_order_.push_back(reply.correlation_id);
  if (finished_order_.size() > kRememberedReplies) {
    finished_.erase(finished_order_.front());
    finished_order_.pop_front();
  }
}

}  // namespace telltale
