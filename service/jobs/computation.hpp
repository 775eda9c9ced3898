#pragma once

#include <condition_variable>
#include <deque>
#include <exception>
#include <functional>
#include <future>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <type_traits>
#include <utility>

#include "telltale/core/identification/progress.hpp"
#include "telltale/service/jobs/urgency.hpp"

namespace telltale {

/// The progress of a computation, on its way from the thread that computes to the one that waits.
/// Thread safe.
class ProgressMailbox {
 public:
  struct Report {
    std::string stage;
    double fraction = 0.0;
  };

  /// Throws what Abandon() was given.
  void Post(std::string_view stage, double fraction);

  /// The next report; nothing once the computation has ended.
  std::optional<Report> Await();

  /// Ends the computation at its next report.
  void Abandon(std::exception_ptr reason);

  /// Nothing more is posted.
  void Close();

 private:
  std::mutex mutex_;  // of what follows
  std::condition_variable changed_;
  std::deque<Report> reports_;  ///< the latest of each stage
  std::exception_ptr abandoned_;
  bool closed_ = false;
};

/// How the computing parts of a job are run: on the worker itself where the job is interactive,
/// else on a thread of their own that leaves the processors to more urgent ones. Such a thread gets
/// no processor for seconds where others are busy, so it must hold nothing that they wait for: it
/// takes no lock of the daemon, writes to no log, topic or store, and its progress is reported by
/// the worker.
class Computation {
 public:
  /// `report` runs on the worker. Where it throws, the computation ends at its next report, and
  /// what it threw comes out of the call.
  Computation(Urgency urgency, Progress report) : urgency_(urgency), report_(std::move(report)) {}

  void Report(std::string_view stage, double fraction) const { report_(stage, fraction); }

  /// What `compute(const Progress&)` returns, or throws.
  template <class Compute>
  std::invoke_result_t<Compute&, const Progress&> operator()(Compute compute) const {
    if (urgency_ == Urgency::kInteractive) return compute(report_);
    ProgressMailbox mailbox;
    std::packaged_task<std::invoke_result_t<Compute&, const Progress&>()> task([&] {
      YieldToMoreUrgentThan(urgency_);
      return compute(
          [&mailbox](std::string_view stage, double fraction) { mailbox.Post(stage, fraction); });
    });
    auto result = task.get_future();
    std::thread computing([&] {
      task();
      mailbox.Close();
    });
    PassOn(mailbox);
    computing.join();
    return result.get();
  }

 private:
  void PassOn(ProgressMailbox& mailbox) const;

  const Urgency urgency_;
  const Progress report_;
};

}  // namespace telltale
