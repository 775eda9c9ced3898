#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "telltale/idl/codec/daemon_config.hpp"
#include "telltale/service/workers/taken_jobs.hpp"

namespace telltale {

/// Takes heavy jobs from the database of the configuration, from construction to destruction, and
/// computes one at a time on all processors. A database that cannot be reached is tried again once
/// a second. Throws DatabaseError where it cannot be reached at the start.
class Worker {
 public:
  /// Requires config.database and config.workers.
  explicit Worker(const DaemonConfig& config);
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;
  ~Worker();  ///< gives back the job under way, and ends the threads

 private:
  void Work();
  void Do(const TakenJob& job);
  std::string OutcomeOf(const TakenJob& job);
  void Answer(const JobClaim& job, const std::string& outcome);
  void Report(std::string_view stage, double fraction);
  void KeepAlive();
  void ProlongJob();
  bool Reaches(const std::function<void()>& work);
  bool Rest(std::chrono::nanoseconds period);

  TakenJobs jobs_;
  const std::chrono::nanoseconds keep_period_;

  std::mutex mutex_;  // of what follows
  std::condition_variable wake_;
  bool stopping_ = false;
  bool reached_last_time_ = true;
  std::optional<JobClaim> job_;  ///< under way
  bool wanted_ = false;          ///< job_ is
  std::string stage_;            ///< of job_
  double fraction_ = 0.0;        ///< likewise
  std::thread keeping_;
  std::thread working_;
};

}  // namespace telltale
