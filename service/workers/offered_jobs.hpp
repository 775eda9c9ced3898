#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>

#include "telltale/service/storage/storage.hpp"

namespace telltale {

/// How a job that a daemon offers stands.
struct OfferedJobState {
  int attempts = 0;    ///< of workers to compute it
  bool taken = false;  ///< a worker that is alive computes it
  std::string worker;  ///< that has taken it last
  std::string stage;   ///< of its computation
  double fraction = 0.0;
  std::optional<std::string> outcome;  ///< PackOutcome(), once it is computed
  int workers = 0;                     ///< that are alive
};

/// The heavy jobs that a daemon offers to workers, in a database of PostgreSQL. A job is offered as
/// long as its daemon asks about it once a lease. Workers of another version of this software do
/// not count. Throws DatabaseError. Safe to use from several threads.
class OfferedJobs {
 public:
  OfferedJobs(const Storage& storage, double lease_s);

  /// How many workers are alive.
  int Workers();

  /// Offers a task, PackTask(). Another of the same correlation id is withdrawn. Returns its
  /// number.
  std::int64_t Offer(std::string_view correlation_id, std::string_view vehicle_id,
                     std::string_view task);

  /// Nothing where the job is not offered any more.
  std::optional<OfferedJobState> Ask(std::int64_t number);

  /// A worker that computes it ends that.
  void Withdraw(std::int64_t number);

 private:
  std::mutex mutex_;  // of database_
  std::unique_ptr<Database> database_;
  const double lease_s_;
};

}  // namespace telltale
