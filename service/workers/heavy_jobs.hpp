#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <string>

#include "telltale/idl/codec/daemon_config.hpp"
#include "telltale/service/jobs/computation.hpp"
#include "telltale/service/workers/heavy_activity.hpp"
#include "telltale/service/workers/heavy_job_codec.hpp"
#include "telltale/service/workers/offered_jobs.hpp"

namespace telltale {

/// Computes the heavy jobs of one queue: by a worker where one is alive, else here, one at a time.
/// Safe to use from several threads.
class HeavyJobs {
 public:
  /// `queue` names them in the log. Without `offered` everything is computed here, and nothing
  /// counts. What it refers to outlives this.
  HeavyJobs(std::string queue, OfferedJobs* offered, const WorkerSettings& settings);

  /// How many threads may ask at a time.
  std::size_t AtATime() const { return offered_ == nullptr ? 1 : settings_.most_jobs; }

  /// What Compute(task) returns, wherever it runs. Throws what that throws, what `computation`
  /// throws at a report, DatabaseError, and std::runtime_error where no worker finishes the job
  /// within the attempts that the settings allow.
  template <class Task>
  auto operator()(const Task& task, const Computation& computation) {
    const auto here = [&] {
      return computation([&](const Progress& progress) { return Compute(task, progress); });
    };
    if (offered_ == nullptr) return here();
    for (;;) {
      const ExchangeRequest& request = task.request;
      if (const auto outcome = ByWorker(
              request, [&] { return PackTask(task); }, computation)) {
        return UnpackOutcome(*outcome, task);
      }
      const std::unique_lock turn(here_, kAskEvery);
      if (turn) {
        NoteHere(request);
        return here();
      }
      computation.Report("waiting", 0.0);
    }
  }

  HeavyActivity Activity() const;

 private:
  static constexpr std::chrono::milliseconds kAskEvery{250};

  /// Nothing where no worker is alive.
  std::optional<std::string> ByWorker(const ExchangeRequest& request,
                                      const std::function<std::string()>& pack,
                                      const Computation& computation);
  std::optional<std::string> Await(std::int64_t number, const ExchangeRequest& request,
                                   const Computation& computation);
  void Note(const OfferedJobState& state, const OfferedJobState& before,
            const ExchangeRequest& request) const;
  void NoteHere(const ExchangeRequest& request);

  const std::string queue_;
  OfferedJobs* const offered_;
  const WorkerSettings settings_;
  std::timed_mutex here_;  ///< whoever holds it computes here
  std::atomic<std::size_t> offers_ = 0;
  std::atomic<std::size_t> taken_ = 0;
  std::atomic<std::uint64_t> answered_ = 0;
  std::atomic<std::uint64_t> given_up_ = 0;
  std::atomic<std::uint64_t> computed_here_ = 0;
};

}  // namespace telltale
