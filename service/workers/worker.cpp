#include "telltale/service/workers/worker.hpp"

#include <algorithm>
#include <chrono>
#include <exception>
#include <utility>
#include <variant>

#include <unistd.h>

#include <spdlog/spdlog.h>
#include <boost/asio/ip/host_name.hpp>

#include "telltale/service/workers/heavy_job_codec.hpp"

namespace telltale {
namespace {

constexpr std::chrono::milliseconds kAskEvery{250};
constexpr std::chrono::seconds kTryAgainPeriod{1};

/// Ends the work on a job when the worker stops.
struct Stopping : std::exception {
  const char* what() const noexcept override { return "the worker is stopping"; }
};
/// Ends the work on a job that nobody waits for.
struct Unwanted : std::exception {
  const char* what() const noexcept override { return "nobody waits for it any more"; }
};

/// A name that no other worker has that runs at the same time.
std::string WorkerName() {
  return boost::asio::ip::host_name() + ':' + std::to_string(getpid());
}

/// Progress shows, and a cancelled job ends, within a second.
std::chrono::nanoseconds KeepPeriodOf(const WorkerSettings& settings) {
  const std::chrono::duration<double> period(std::min(1.0, settings.lease_s / 4.0));
  return std::chrono::duration_cast<std::chrono::nanoseconds>(period);
}

}  // namespace

Worker::Worker(const DaemonConfig& config)
    : jobs_(Storage(config.state_directory, config.database), WorkerName(), *config.workers),
      keep_period_(KeepPeriodOf(*config.workers)),
      keeping_([this] { KeepAlive(); }),
      working_([this] { Work(); }) {}

Worker::~Worker() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  wake_.notify_all();
  working_.join();
  keeping_.join();
}

void Worker::Work() {
  std::optional<TakenJob> job;
  do {
    job.reset();
    if (Reaches([&] { job = jobs_.Take(); }) && job) Do(*job);
  } while (Rest(job ? std::chrono::nanoseconds(0) : kAskEvery));
}

/// Every fault of a job ends in its outcome.
void Worker::Do(const TakenJob& job) {
  spdlog::info("job {} of {} for {} is begun, attempt {}", job.number, job.vehicle_id,
               job.correlation_id, job.attempt);
  {
    const std::lock_guard lock(mutex_);
    job_ = job;
    wanted_ = true;
    stage_.clear();
    fraction_ = 0.0;
  }
  const auto begun = std::chrono::steady_clock::now();
  try {
    Answer(job, OutcomeOf(job));
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begun;
    spdlog::info("job {} is ended in {:.3f} s", job.number, took.count());
  } catch (const Unwanted& ended) {
    spdlog::info("job {}: {}", job.number, ended.what());
  } catch (const Stopping& ended) {
    Reaches([&] { jobs_.GiveBack(job); });
    spdlog::info("job {} is given back: {}", job.number, ended.what());
  }
  const std::lock_guard lock(mutex_);
  job_.reset();
}

std::string Worker::OutcomeOf(const TakenJob& job) {
  const auto task = UnpackTask(job.task);
  if (!task) return PackFailure("a worker cannot read the job: " + task.error().Message());
  const Progress progress = [this](std::string_view stage, double fraction) {
    Report(stage, fraction);
  };
  try {
    return std::visit([&](const auto& kind) { return PackOutcome(Compute(kind, progress)); },
                      *task);
  } catch (const Unwanted&) {
    throw;
  } catch (const Stopping&) {
    throw;
  } catch (const std::exception& error) {
    return PackFailure(error.what());
  }
}

/// A database that cannot be reached is awaited, since the work is done.
void Worker::Answer(const JobClaim& job, const std::string& outcome) {
  bool is_mine = false;
  while (!Reaches([&] { is_mine = jobs_.Answer(job, outcome); })) {
    if (!Rest(kTryAgainPeriod)) return;
  }
  if (!is_mine) throw Unwanted();
}

void Worker::Report(std::string_view stage, double fraction) {
  const std::lock_guard lock(mutex_);
  if (stopping_) throw Stopping();
  if (!wanted_) throw Unwanted();
  stage_ = stage;
  fraction_ = fraction;
}

void Worker::KeepAlive() {
  do {
    Reaches([this] {
      jobs_.BeAlive();
      ProlongJob();
    });
  } while (Rest(keep_period_));
}

void Worker::ProlongJob() {
  std::unique_lock lock(mutex_);
  const auto job = job_;
  const auto [stage, fraction] = std::pair(stage_, fraction_);
  lock.unlock();
  if (!job || jobs_.Prolong(*job, stage, fraction)) return;
  lock.lock();
  if (job_ && job_->number == job->number) wanted_ = false;
}

/// False where the database refuses, which the log says once.
bool Worker::Reaches(const std::function<void()>& work) {
  std::string fault;
  try {
    work();
  } catch (const DatabaseError& error) {
    fault = error.what();
  }
  const std::lock_guard lock(mutex_);
  if (fault.empty() == reached_last_time_) return fault.empty();
  reached_last_time_ = fault.empty();
  fault.empty() ? spdlog::info("jobs can be taken again")
                : spdlog::error("{}; no job can be taken or answered", fault);
  return fault.empty();
}

/// False once the worker is to stop.
bool Worker::Rest(std::chrono::nanoseconds period) {
  std::unique_lock lock(mutex_);
  return !wake_.wait_for(lock, period, [this] { return stopping_; });
}

}  // namespace telltale
