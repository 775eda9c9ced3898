#include "identification/identification_jobs.hpp"

#include <algorithm>
#include <chrono>
#include <exception>
#include <utility>

#include <spdlog/spdlog.h>

#include "monitoring/prediction_error.hpp"

namespace telltale {
namespace {

using Clock = std::chrono::steady_clock;

// Replies hold models of some ten kilobytes; whoever asks again does so within seconds.
constexpr std::size_t kRememberedReplies = 256;

constexpr double kReportedStep = 0.02;

/// Unwinds an identification when the daemon stops.
struct Stopping : std::exception {
  const char* what() const noexcept override { return "the daemon is stopping"; }
};

IdentifyReply ReplyTo(const IdentifyRequest& request, IdentifyOutcome outcome,
                      std::string message = {}) {
  IdentifyReply reply;
  reply.correlation_id = request.correlation_id;
  reply.vehicle_id = request.vehicle_id;
  reply.outcome = outcome;
  reply.message = std::move(message);
  return reply;
}

IdentifyReply Failed(const IdentifyRequest& request, std::string message) {
  return ReplyTo(request, IdentifyOutcome::kFailed, std::move(message));
}

}  // namespace

IdentifyOptions OptionsOf(const IdentifyRequest& request, const IdentificationSettings& settings) {
  IdentifyOptions options;
  options.prepare =
      request.preset == Preset::kPaper ? PrepareOptions::Paper() : PrepareOptions::Robust();
  if (request.structure != Structure::kUnknown) options.regression.structure = request.structure;
  if (request.parameterization != Parameterization::kUnknown) {
    options.regression.parameterization = request.parameterization;
  }
  if (request.estimator != Estimator::kUnknown) {
    options.estimator = request.estimator;
  } else if (request.preset == Preset::kPaper) {
    options.estimator = Estimator::kOneStep;  // the paper's own, and the only one for its preset
  }
  if (request.dead_zone_source != DeadZoneSource::kUnknown) {
    options.dead_zone_source = request.dead_zone_source;
    options.regression.dead_zone = request.dead_zone;
  }
  options.regression.include_reverse = request.include_reverse;
  options.interval_level = settings.interval_level;
  options.bootstrap_replicates =
      request.bootstrap_replicates.value_or(settings.bootstrap_replicates);
  if (request.resampling != Resampling::kUnknown) options.resampling = request.resampling;
  if (request.resampling == Resampling::kParametric) {
    options.interval_method = IntervalMethod::kStudentized;  // which alone takes the bias out
  }
  if (request.interval_method != IntervalMethod::kUnknown) {
    options.interval_method = request.interval_method;
  }
  options.certificate_twins = request.certificate_twins;
  options.seed = request.seed;
  options.threads = std::max(1u, std::thread::hardware_concurrency() / settings.workers);
  return options;
}

IdentificationJobs::IdentificationJobs(Fleet& fleet, PublishedModels& models, Answers& answers,
                                       const IdentificationSettings& settings)
    : fleet_(fleet), models_(models), answers_(answers), settings_(settings) {
  for (std::uint32_t i = 0; i < settings.workers; ++i) {
    workers_.emplace_back([this] { Work(); });
  }
}

IdentificationJobs::~IdentificationJobs() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  changed_.notify_all();
  for (std::thread& worker : workers_) worker.join();
  for (const IdentifyRequest& request : queue_) answers_.Send(Failed(request, Stopping().what()));
}

void IdentificationJobs::Submit(IdentifyRequest request) {
  std::unique_lock lock(mutex_);
  if (const auto done = finished_.find(request.correlation_id); done != finished_.end()) {
    const IdentifyReply reply = done->second;
    lock.unlock();
    return answers_.Send(reply);
  }
  if (const auto known = unfinished_.find(request.correlation_id); known != unfinished_.end()) {
    const IdentifyProgress progress = known->second;
    lock.unlock();
    return answers_.Send(progress);
  }
  if (fleet_.Find(request.vehicle_id) == nullptr) {
    lock.unlock();
    return answers_.Send(Failed(request, "vehicle '" + request.vehicle_id +
                                             "' is not served here; served: " + fleet_.Served()));
  }
  if (queue_.size() >= settings_.queue_limit) {
    lock.unlock();
    return answers_.Send(Failed(request, std::to_string(settings_.queue_limit) +
                                             " identifications are waiting already; ask later"));
  }
  const IdentifyProgress progress{request.correlation_id, request.vehicle_id, "queued", 0.0};
  unfinished_.emplace(request.correlation_id, progress);
  queue_.push_back(std::move(request));
  lock.unlock();
  changed_.notify_one();
  answers_.Send(progress);
}

void IdentificationJobs::Work() {
  std::unique_lock lock(mutex_);
  for (;;) {
    changed_.wait(lock, [this] { return stopping_ || NextRunnable() != queue_.end(); });
    if (stopping_) return;
    const auto next = NextRunnable();
    const IdentifyRequest request = std::move(*next);
    queue_.erase(next);
    running_vehicles_.insert(request.vehicle_id);
    lock.unlock();
    const IdentifyReply reply = Answer(request);
    lock.lock();
    running_vehicles_.erase(request.vehicle_id);
    unfinished_.erase(request.correlation_id);
    Remember(reply);
    lock.unlock();
    changed_.notify_all();
    answers_.Send(reply);
    lock.lock();
  }
}

IdentificationJobs::Queue::iterator IdentificationJobs::NextRunnable() {
  return std::ranges::find_if(queue_, [this](const IdentifyRequest& request) {
    return !running_vehicles_.contains(request.vehicle_id);
  });
}

IdentifyReply IdentificationJobs::Answer(const IdentifyRequest& request) {
  const auto start = Clock::now();
  IdentifyReply reply;
  try {
    reply = IdentifyAndPublish(request);
  } catch (const std::exception& error) {
    reply = Failed(request, error.what());
  }
  reply.elapsed_s = std::chrono::duration<double>(Clock::now() - start).count();
  spdlog::info("identification of {} for {}: {} in {:.3f} s {}", request.vehicle_id,
               request.correlation_id, Name(reply.outcome), reply.elapsed_s, reply.message);
  return reply;
}

IdentifyReply IdentificationJobs::IdentifyAndPublish(const IdentifyRequest& request) {
  const IdentifyOptions options = OptionsOf(request, settings_);
  if (const auto fault = options.Validate()) {
    return Failed(request, fault->subject + ": " + fault->reason + "; " + fault->advice);
  }
  VehicleWindow& window = *fleet_.Find(request.vehicle_id);
  const Recording recording = window.Snapshot();
  const auto identification =
      Identify(recording, window.vehicle(), options,
               [&](std::string_view stage, double fraction) { Report(request, stage, fraction); });
  if (!identification) {
    IdentifyReply reply = ReplyTo(request, IdentifyOutcome::kRefused);
    reply.refusals.push_back(identification.error());
    return reply;
  }
  Report(request, "publish", 1.0);
  IdentifyReply reply = ReplyTo(request, IdentifyOutcome::kPublished);
  reply.model = models_.Publish(*identification,
                                MeasureFreeRunError(recording, window.vehicle(), *identification));
  return reply;
}

void IdentificationJobs::Report(const IdentifyRequest& request, std::string_view stage,
                                double fraction) {
  if (stopping_) throw Stopping();
  IdentifyProgress progress;
  {
    const std::lock_guard lock(mutex_);
    IdentifyProgress& last = unfinished_.find(request.correlation_id)->second;
    if (last.stage == stage && fraction - last.fraction < kReportedStep) return;
    last.stage = stage;
    last.fraction = std::clamp(fraction, 0.0, 1.0);
    progress = last;
  }
  answers_.Send(progress);
}

void IdentificationJobs::Remember(const IdentifyReply& reply) {
  finished_.insert_or_assign(reply.correlation_id, reply);
  finished_order_.push_back(reply.correlation_id);
  if (finished_order_.size() > kRememberedReplies) {
    finished_.erase(finished_order_.front());
    finished_order_.pop_front();
  }
}

}  // namespace telltale
