#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>

#include "telltale/idl/codec/daemon_config.hpp"
#include "telltale/service/storage/storage.hpp"

namespace telltale {

/// Under which a worker computes a job.
struct JobClaim {
  std::int64_t number = 0;   ///< of the job
  std::int64_t attempt = 0;  ///< counts from 1
};

/// A job that a worker has taken.
struct TakenJob : JobClaim {
  std::string correlation_id;
  std::string vehicle_id;
  std::string task;  ///< PackTask()
};

/// The worker's side of OfferedJobs. A job is its worker's as long as that prolongs it once a
/// lease; then another takes it. The attempt tells one taking from the next: a worker that was
/// suspended cannot write of a job that another has by then. Throws DatabaseError. Safe to use from
/// several threads.
class TakenJobs {
 public:
  /// `worker` names this worker and no other that runs.
  TakenJobs(const Storage& storage, std::string worker, const WorkerSettings& settings);
  TakenJobs(const TakenJobs&) = delete;
  TakenJobs& operator=(const TakenJobs&) = delete;
  ~TakenJobs();  ///< the worker counts as gone

  /// The worker counts as alive for another lease.
  void BeAlive();

  /// The oldest job that waits; nothing where none does. Drops those that no daemon wants.
  std::optional<TakenJob> Take();

  /// The next three are false where the job is no longer this worker's, or is not wanted.
  bool Prolong(const JobClaim& job, std::string_view stage, double fraction);
  bool Answer(const JobClaim& job, std::string_view outcome);
  /// Leaves it to another at once, as if it had not been begun.
  bool GiveBack(const JobClaim& job);

 private:
  std::mutex mutex_;  // of database_
  std::unique_ptr<Database> database_;
  const std::string worker_;
  const WorkerSettings settings_;
};

}  // namespace telltale
