#include "telltale/service/workers/heavy_jobs.hpp"

#include <exception>
#include <stdexcept>
#include <thread>
#include <utility>

#include <spdlog/spdlog.h>

namespace telltale {
namespace {

/// One more in a count while this stands.
class Counted {
 public:
  explicit Counted(std::atomic<std::size_t>& count) : count_(count) { ++count_; }
  Counted(const Counted&) = delete;
  Counted& operator=(const Counted&) = delete;
  ~Counted() { --count_; }

 private:
  std::atomic<std::size_t>& count_;
};

/// A task that is offered while this stands.
class Offer {
 public:
  Offer(OfferedJobs& jobs, const ExchangeRequest& request, const std::string& task)
      : jobs_(jobs), number_(jobs.Offer(request.correlation_id, request.vehicle_id, task)) {}
  Offer(const Offer&) = delete;
  Offer& operator=(const Offer&) = delete;
  ~Offer() {
    try {
      jobs_.Withdraw(number_);
    } catch (const std::exception& error) {
      spdlog::warn("{}; a job stays offered for a lease", error.what());
    }
  }

  std::int64_t number() const { return number_; }

 private:
  OfferedJobs& jobs_;
  const std::int64_t number_;
};

}  // namespace

HeavyJobs::HeavyJobs(std::string queue, OfferedJobs* offered, const WorkerSettings& settings)
    : queue_(std::move(queue)), offered_(offered), settings_(settings) {}

std::optional<std::string> HeavyJobs::ByWorker(const ExchangeRequest& request,
                                               const std::function<std::string()>& pack,
                                               const Computation& computation) {
  if (offered_->Workers() == 0) return std::nullopt;
  const Counted counted(offers_);
  const Offer offer(*offered_, request, pack());
  return Await(offer.number(), request, computation);
}

/// The outcome; nothing where no worker is left.
std::optional<std::string> HeavyJobs::Await(std::int64_t number, const ExchangeRequest& request,
                                            const Computation& computation) {
  std::optional<Counted> counted_as_taken;
  OfferedJobState before;
  for (;;) {
    auto state = offered_->Ask(number);
    if (!state) return std::nullopt;
    Note(*state, before, request);
    if (state->outcome) {
      ++answered_;
      return std::move(state->outcome);
    }
    if (!state->taken && state->attempts >= static_cast<int>(settings_.attempts)) {
      ++given_up_;
      throw std::runtime_error(std::to_string(state->attempts) +
                               " workers have begun it, and none has finished it");
    }
    if (!state->taken && state->workers == 0) return std::nullopt;
    if (!state->taken) counted_as_taken.reset();
    if (state->taken && !counted_as_taken) counted_as_taken.emplace(taken_);
    state->taken
        ? computation.Report(state->stage.empty() ? "taken" : state->stage, state->fraction)
        : computation.Report("waiting for a worker", 0.0);
    before = *std::move(state);
    std::this_thread::sleep_for(kAskEvery);
  }
}

/// Says once what has changed.
void HeavyJobs::Note(const OfferedJobState& state, const OfferedJobState& before,
                     const ExchangeRequest& request) const {
  if (before.taken && (!state.taken || state.attempts != before.attempts) && !state.outcome) {
    spdlog::warn("{} of {} for {}: worker {} has not finished it", queue_, request.vehicle_id,
                 request.correlation_id, before.worker);
  }
  if (state.attempts > before.attempts) {
    spdlog::info("{} of {} for {}: worker {} computes it", queue_, request.vehicle_id,
                 request.correlation_id, state.worker);
  }
}

void HeavyJobs::NoteHere(const ExchangeRequest& request) {
  ++computed_here_;
  spdlog::warn("{} of {} for {}: no worker is alive, this daemon computes it", queue_,
               request.vehicle_id, request.correlation_id);
}

HeavyActivity HeavyJobs::Activity() const {
  const std::size_t taken = taken_;
  const std::size_t offers = offers_;
  return {queue_, offers > taken ? offers - taken : 0, taken, answered_, given_up_, computed_here_};
}

}  // namespace telltale
