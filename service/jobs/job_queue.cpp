#include "telltale/service/jobs/job_queue.hpp"

#include <algorithm>
#include <cmath>

#include <spdlog/spdlog.h>

#include "telltale/service/freed_memory.hpp"

namespace telltale {

template <class Request, class Stage, class Reply>
JobQueue<Request, Stage, Reply>::JobQueue(std::string what, const Fleet& fleet,
                                          ReplyPublisher& replies, const Workers& workers,
                                          std::size_t queue_limit, Work work,
                                          RequestJournal* journal)
    : what_(std::move(what)),
      fleet_(fleet),
      replies_(replies),
      worker_counts_(workers),
      queue_limit_(queue_limit),
      work_(std::move(work)),
      journal_(journal) {
  for (const Urgency urgency : kUrgencies) {
    for (std::size_t i = 0; i < workers.Of(urgency); ++i) {
      workers_.emplace_back([this, urgency] { Run(urgency); });
    }
  }
}

template <class Request, class Stage, class Reply>
JobQueue<Request, Stage, Reply>::~JobQueue() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  changed_.notify_all();
  for (std::thread& worker : workers_) worker.join();
  Outbox outbox;
  for (const auto& job : jobs_) {
    Dismiss(*job, std::exchange(job->askers, {}), Stopping().what(), outbox);
  }
  Send(outbox);
}

template <class Request, class Stage, class Reply>
void JobQueue<Request, Stage, Reply>::Submit(Request request, Urgency urgency, Answer answer,
                                             WriterHandle client) {
  std::unique_lock lock(mutex_);
  if (const auto known = history_.Find(request.correlation_id)) {
    const bool may_hear = Prolong(request, client);
    lock.unlock();
    if (!may_hear) return;
    return std::visit([this](const auto& message) { replies_.Send(message); }, *known);
  }
  Asker asker{request.correlation_id, DeadlineOf(request), std::move(answer), client, {}, {}};
  const auto same = JobLike(request, urgency);
  auto rejection = RejectionByShare(request, urgency, client);
  if (!rejection && !same) rejection = RejectionOf(request, urgency);
  if (rejection) {
    lock.unlock();
    Log(request, *rejection, 1);
    return Send({{std::move(asker), *rejection}});
  }
  const bool on_the_bus = !asker.answer;
  const Stage stage{{request.correlation_id, request.vehicle_id, std::string(kQueuedStage), 0.0}};
  history_.Begin(stage);
  const bool kept = on_the_bus && journal_ != nullptr;
  if (kept) {
    asker.kept = std::make_shared<std::atomic<bool>>(false);
    journal_->Keep(request, [&replies = replies_, stage, kept = asker.kept] {
      *kept = true;
      replies.Send(stage);
    });
  }
  if (same) {
    same->urgency = same->Waits() ? std::min(same->urgency, urgency) : same->urgency;
    same->askers.push_back(std::move(asker));
  } else {
    Queue(std::move(request), urgency, std::move(asker));
  }
  lock.unlock();
  changed_.notify_all();
  if (on_the_bus && !kept) replies_.Send(stage);
}

template <class Request, class Stage, class Reply>
auto JobQueue<Request, Stage, Reply>::DeadlineOf(const Request& request)
    -> std::optional<Clock::time_point> {
  constexpr double kLongestS = 1e6;
  if (request.deadline_s <= 0.0) return std::nullopt;
  const std::chrono::duration<double> patience(std::min(request.deadline_s, kLongestS));
  return Clock::now() + std::chrono::duration_cast<Clock::duration>(patience);
}

/// Somebody asks again, and so waits on. Returns whether the asker may hear how the request stands.
/// The caller holds mutex_, as for all that follow up to Run().
template <class Request, class Stage, class Reply>
bool JobQueue<Request, Stage, Reply>::Prolong(const Request& request, WriterHandle client) {
  bool may_hear = true;
  for (const auto& job : jobs_) {
    for (Asker& asker : job->askers) {
      if (asker.correlation_id != request.correlation_id) continue;
      asker.deadline = DeadlineOf(request);
      asker.client = client;
      asker.gone_since.reset();
      may_hear = asker.MayHear();
    }
  }
  return may_hear;
}

template <class Request, class Stage, class Reply>
void JobQueue<Request, Stage, Reply>::Queue(Request request, Urgency urgency, Asker asker) {
  auto job = std::make_shared<Job>();
  job->request = std::move(request);
  job->urgency = urgency;
  job->number = ++submitted_;
  job->askers.push_back(std::move(asker));
  jobs_.push_back(std::move(job));
}

/// An unfinished job that the request may join: one that waits, since it can still become as urgent
/// as the request, or one that was begun just now and is as urgent.
template <class Request, class Stage, class Reply>
auto JobQueue<Request, Stage, Reply>::JobLike(const Request& request, Urgency urgency) const
    -> std::shared_ptr<Job> {
  const auto now = Clock::now();
  const auto found = std::ranges::find_if(jobs_, [&](const auto& job) {
    const bool is_fresh = job->Waits() || now - *job->started < kJoinedWithin;
    const bool is_soon_enough = job->Waits() || job->urgency <= urgency;
    return is_fresh && is_soon_enough && !job->askers.empty() && AskTheSame(job->request, request);
  });
  return found == jobs_.end() ? nullptr : *found;
}

template <class Request, class Stage, class Reply>
std::size_t JobQueue<Request, Stage, Reply>::Waiting() const {
  return static_cast<std::size_t>(
      std::ranges::count_if(jobs_, [](const auto& job) { return job->Waits(); }));
}

template <class Request, class Stage, class Reply>
auto JobQueue<Request, Stage, Reply>::LongestSilence() const -> Clock::duration {
  Clock::duration longest{0};
  const auto now = Clock::now();
  for (const auto& job : jobs_) {
    if (!job->Waits()) longest = std::max(longest, now - job->advanced);
  }
  return longest;
}

template <class Request, class Stage, class Reply>
QueueActivity JobQueue<Request, Stage, Reply>::Activity() const {
  const std::lock_guard lock(mutex_);
  const std::size_t waiting = Waiting();
  return {what_, waiting, jobs_.size() - waiting, workers_.size(), LongestSilence(), shed_};
}

/// Why the queue cannot take a request.
template <class Request, class Stage, class Reply>
std::optional<Reply> JobQueue<Request, Stage, Reply>::RejectionOf(const Request& request,
                                                                  Urgency urgency) {
  if (fleet_.Find(request.vehicle_id) == nullptr) {
    return Failed(request, fleet_.NotServed(request.vehicle_id));
  }
  const auto unavailable = journal_ == nullptr ? std::nullopt : journal_->Unavailable();
  if (unavailable) return Busy(request, *unavailable, kUnavailableS);
  if (Waiting() < queue_limit_) return std::nullopt;
  ++shed_;
  return Busy(request,
              std::to_string(queue_limit_) + " requests for " + what_ + " are waiting already",
              RetryAfterS(urgency));
}

/// One client may not keep the others out.
template <class Request, class Stage, class Reply>
std::optional<Reply> JobQueue<Request, Stage, Reply>::RejectionByShare(const Request& request,
                                                                       Urgency urgency,
                                                                       WriterHandle client) {
  const std::size_t share = std::max<std::size_t>(1, queue_limit_ / 4);
  if (client == kNoClient || UnansweredOf(client) < share) return std::nullopt;
  ++shed_;
  return Busy(
      request,
      std::to_string(share) + " requests of this client for " + what_ + " have no answer yet",
      RetryAfterS(urgency));
}

template <class Request, class Stage, class Reply>
std::size_t JobQueue<Request, Stage, Reply>::UnansweredOf(WriterHandle client) const {
  std::ptrdiff_t unanswered = 0;
  for (const auto& job : jobs_) {
    unanswered += std::ranges::count(job->askers, client, &Asker::client);
  }
  return static_cast<std::size_t>(unanswered);
}

/// Until about half of what waits has been worked on.
template <class Request, class Stage, class Reply>
double JobQueue<Request, Stage, Reply>::RetryAfterS(Urgency urgency) const {
  constexpr double kLongestS = 60.0;
  const auto workers = static_cast<double>(std::max<std::size_t>(1, worker_counts_.Of(urgency)));
  const double half_s = 0.5 * mean_duration_s_ * static_cast<double>(Waiting()) / workers;
  return std::clamp(std::ceil(half_s), 1.0, kLongestS);
}

template <class Request, class Stage, class Reply>
auto JobQueue<Request, Stage, Reply>::NextRunnable(Urgency urgency) const -> std::shared_ptr<Job> {
  std::shared_ptr<Job> next;
  std::uint64_t next_served = 0;
  for (const auto& job : jobs_) {
    const std::string& vehicle_id = job->request.vehicle_id;
    if (!job->Waits() || job->urgency != urgency) continue;
    if (running_vehicles_.contains({urgency, vehicle_id})) continue;
    const auto found = last_begun_.find({urgency, vehicle_id});
    const std::uint64_t served = found == last_begun_.end() ? 0 : found->second;
    if (next && served >= next_served) continue;
    next = job;
    next_served = served;
  }
  return next;
}

template <class Request, class Stage, class Reply>
auto JobQueue<Request, Stage, Reply>::EarliestDeadline() const -> std::optional<Clock::time_point> {
  std::optional<Clock::time_point> earliest;
  for (const auto& job : jobs_) {
    for (const Asker& asker : job->askers) {
      if (const auto until = asker.WaitsUntil())
        earliest = std::min(earliest.value_or(*until), *until);
    }
  }
  return earliest;
}

template <class Request, class Stage, class Reply>
void JobQueue<Request, Stage, Reply>::NoteClients(const std::set<WriterHandle>& connected) {
  bool has_lost = false;  // a client, so that a job may have to be dropped sooner
  {
    const std::lock_guard lock(mutex_);
    for (const auto& job : jobs_) {
      for (Asker& asker : job->askers) {
        const bool is_there = asker.client == kNoClient || connected.contains(asker.client);
        if (is_there) {
          asker.gone_since.reset();
        } else if (!asker.gone_since) {
          asker.gone_since = Clock::now();
          has_lost = true;
        }
      }
    }
  }
  if (has_lost) changed_.notify_all();
}

/// Dismisses the askers who wait no longer, and drops the jobs that nobody waits for.
template <class Request, class Stage, class Reply>
auto JobQueue<Request, Stage, Reply>::Expire() -> Outbox {
  Outbox outbox;
  const auto now = Clock::now();
  for (const auto& job : jobs_) {
    Dismiss(*job, job->TakeAskers([now](const Asker& asker) { return asker.GivesUpBy(now); }),
            "its deadline has passed", outbox);
    for (Asker& gone : job->TakeAskers([now](const Asker& asker) { return asker.IsGoneBy(now); })) {
      const std::string why = "its client is gone";
      spdlog::info("{} of {} for {} is dropped: {}", what_, job->request.vehicle_id,
                   gone.correlation_id, why);
      Dismiss(*job, {std::move(gone)}, why, outbox);
    }
  }
  // Who waits after all asks again, and that starts anew.
  for (auto& [asker, reply] : outbox) {
    reply.retry_after_s = kAskAgainS;
    history_.Forget(asker.correlation_id);
  }
  std::erase_if(jobs_, [](const auto& job) { return job->Waits() && job->askers.empty(); });
  return outbox;
}

template <class Request, class Stage, class Reply>
void JobQueue<Request, Stage, Reply>::Dismiss(const Job& job, std::vector<Asker> askers,
                                              const std::string& why, Outbox& outbox) {
  for (Asker& asker : askers) {
    Reply reply = Failed(job.request, why);
    reply.correlation_id = asker.correlation_id;
    outbox.emplace_back(std::move(asker), std::move(reply));
  }
}

template <class Request, class Stage, class Reply>
void JobQueue<Request, Stage, Reply>::GiveUp(const Request& request, const std::string& reason) {
  const Reply reply = Failed(request, reason);
  {
    const std::lock_guard lock(mutex_);
    history_.Finish(reply);
  }
  Log(request, reply, 1);
  Send({{Asker{request.correlation_id, {}, {}, kNoClient, {}, {}}, reply}});
}

template <class Request, class Stage, class Reply>
bool JobQueue<Request, Stage, Reply>::Cancel(const std::string& correlation_id) {
  Outbox outbox;
  {
    const std::lock_guard lock(mutex_);
    for (const auto& job : jobs_) {
      Dismiss(*job, job->TakeAskers([&](const Asker& asker) {
        return asker.correlation_id == correlation_id;
      }),
              "it was cancelled", outbox);
    }
    std::erase_if(jobs_, [](const auto& job) { return job->Waits() && job->askers.empty(); });
    for (const auto& [asker, reply] : outbox) history_.Finish(reply);
  }
  Send(outbox);
  if (!outbox.empty()) spdlog::info("{} for {} was cancelled", what_, correlation_id);
  return !outbox.empty();
}

/// The caller does not hold mutex_, since a stalled client may block it for a while.
template <class Request, class Stage, class Reply>
void JobQueue<Request, Stage, Reply>::Send(const Outbox& outbox) {
  for (const auto& [asker, reply] : outbox) {
    if (asker.answer) {
      asker.answer(reply);
      continue;
    }
    replies_.Send(reply);
    if (journal_ != nullptr) journal_->Drop(asker.correlation_id);
  }
}

template <class Request, class Stage, class Reply>
void JobQueue<Request, Stage, Reply>::Run(Urgency urgency) {
  while (const auto job = AwaitNext(urgency)) {
    CountAttempts(job);
    Finish(job, Execute(job));
    if (!HasWorkFor(urgency)) ReturnFreedMemory();
  }
}

template <class Request, class Stage, class Reply>
bool JobQueue<Request, Stage, Reply>::HasWorkFor(Urgency urgency) const {
  const std::lock_guard lock(mutex_);
  return NextRunnable(urgency) != nullptr;
}

template <class Request, class Stage, class Reply>
void JobQueue<Request, Stage, Reply>::CountAttempts(const std::shared_ptr<Job>& job) {
  if (journal_ == nullptr) return;
  std::vector<std::string> correlation_ids;
  {
    const std::lock_guard lock(mutex_);
    for (const Asker& asker : job->askers) correlation_ids.push_back(asker.correlation_id);
  }
  for (const std::string& id : correlation_ids) journal_->CountAttempt(id);
}

/// The next job of this urgency, begun; null when the daemon stops.
template <class Request, class Stage, class Reply>
auto JobQueue<Request, Stage, Reply>::AwaitNext(Urgency urgency) -> std::shared_ptr<Job> {
  std::unique_lock lock(mutex_);
  while (!stopping_) {
    if (const Outbox expired = Expire(); !expired.empty()) {
      lock.unlock();
      Send(expired);
      lock.lock();
      continue;
    }
    if (auto next = NextRunnable(urgency)) {
      next->started = next->advanced = Clock::now();
      running_vehicles_.emplace(urgency, next->request.vehicle_id);
      last_begun_[{urgency, next->request.vehicle_id}] = ++begun_;
      return next;
    }
    if (const auto deadline = EarliestDeadline()) {
      changed_.wait_until(lock, *deadline);
    } else {
      changed_.wait(lock);
    }
  }
  return nullptr;
}

template <class Request, class Stage, class Reply>
void JobQueue<Request, Stage, Reply>::Finish(const std::shared_ptr<Job>& job, Reply reply) {
  constexpr double kNewestWeight = 0.2;
  Outbox outbox;
  {
    const std::lock_guard lock(mutex_);
    mean_duration_s_ += kNewestWeight * (reply.elapsed_s - mean_duration_s_);
    running_vehicles_.erase({job->urgency, job->request.vehicle_id});
    jobs_.remove(job);
    for (Asker& asker : job->askers) {
      reply.correlation_id = asker.correlation_id;
      reply.retry_after_s > 0.0 ? history_.Forget(reply.correlation_id) : history_.Finish(reply);
      outbox.emplace_back(std::move(asker), reply);
    }
  }
  changed_.notify_all();
  Log(job->request, reply, outbox.size());
  Send(outbox);
}

template <class Request, class Stage, class Reply>
Reply JobQueue<Request, Stage, Reply>::Execute(const std::shared_ptr<Job>& job) {
  Reply reply;
  try {
    reply =
        work_(job->request, Computation(job->urgency, [&](std::string_view stage, double fraction) {
                Report(job, stage, fraction);
              }));
  } catch (const DatabaseUnavailable& error) {
    reply = Busy(job->request, error.what(), kUnavailableS);
  } catch (const NotServedError& error) {
    const bool elsewhere = fleet_.IsServedElsewhere(job->request.vehicle_id);
    reply = elsewhere ? Busy(job->request, error.what(), kAskAgainS)
                      : Failed(job->request, error.what());
  } catch (const std::exception& error) {
    reply = Failed(job->request, error.what());
  }
  reply.elapsed_s = std::chrono::duration<double>(Clock::now() - *job->started).count();
  return reply;
}

/// With each reason. A flood of requests writes a bounded number of lines.
template <class Request, class Stage, class Reply>
void JobQueue<Request, Stage, Reply>::Log(const Request& request, const Reply& reply,
                                          std::size_t askers) {
  std::optional<std::uint64_t> not_shown;
  {
    const std::lock_guard lock(mutex_);
    not_shown = log_limit_.Admit(Clock::now());
  }
  if (!not_shown) return;
  std::string reasons = reply.message;
  for (const Refusal& refusal : reply.refusals) {
    if (!reasons.empty()) reasons += "; ";
    reasons += refusal.subject + ": " + refusal.reason;
  }
  if (askers > 1) reasons += " (asked " + std::to_string(askers) + " times)";
  if (*not_shown > 0) reasons += " (" + std::to_string(*not_shown) + " more not shown)";
  const auto level = reply.outcome == ReplyOutcome::kPublished ? spdlog::level::info
                     : reply.outcome == ReplyOutcome::kRefused ? spdlog::level::warn
                                                               : spdlog::level::err;
  spdlog::log(level, "{} of {} for {}: {} in {:.3f} s{}{}", what_, request.vehicle_id,
              request.correlation_id, Name(reply.outcome), reply.elapsed_s,
              reasons.empty() ? "" : ": ", reasons);
}

template <class Request, class Stage, class Reply>
void JobQueue<Request, Stage, Reply>::Report(const std::shared_ptr<Job>& job,
                                             std::string_view stage, double fraction) {
  if (stopping_) throw Stopping();
  std::vector<Stage> reports;
  Outbox expired;
  bool abandoned = false;
  {
    const std::lock_guard lock(mutex_);
    job->advanced = Clock::now();
    expired = Expire();
    abandoned = job->askers.empty();
    for (const Asker& asker : job->askers) {
      auto progress = history_.Advance(asker.correlation_id, stage, fraction);
      if (progress && asker.MayHear()) reports.push_back(std::move(*progress));
    }
  }
  Send(expired);
  if (abandoned) throw Abandoned();
  for (const Stage& progress : reports) replies_.Send(progress);
}

template class JobQueue<IdentifyRequest, IdentifyProgress, IdentifyReply>;
template class JobQueue<DiagnoseRequest, DiagnoseProgress, DiagnoseReply>;

}  // namespace telltale
