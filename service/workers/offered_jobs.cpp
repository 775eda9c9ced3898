#include "telltale/service/workers/offered_jobs.hpp"

#include <spdlog/fmt/fmt.h>

#include "telltale/core/base/version.hpp"
#include "telltale/service/storage/server_clock.hpp"
#include "telltale/service/storage/stores.hpp"

namespace telltale {
namespace {

/// $1: the version.
std::string CountOfWorkers() {
  return fmt::format(
      "(SELECT COUNT(*) FROM workers WHERE workers.version = $1 AND until_unix_s > {})",
      kServerNow);
}

}  // namespace

OfferedJobs::OfferedJobs(const Storage& storage, double lease_s)
    : database_(storage.Open(JobsSchema())), lease_s_(lease_s) {}

int OfferedJobs::Workers() {
  const std::lock_guard lock(mutex_);
  return static_cast<int>(
      IntegerOf(*database_, "SELECT " + CountOfWorkers() + " AS value", {Version()}));
}

std::int64_t OfferedJobs::Offer(std::string_view correlation_id, std::string_view vehicle_id,
                                std::string_view task) {
  const std::lock_guard lock(mutex_);
  std::int64_t number = 0;
  database_->InTransaction([&] {
    database_->Execute("DELETE FROM jobs WHERE correlation_id = $1", {correlation_id});
    number = IntegerOf(
        *database_,
        fmt::format("INSERT INTO jobs (correlation_id, vehicle_id, version, wanted_until_unix_s,"
                    " task) VALUES ($1, $2, $3, {} + $4, $5) RETURNING number AS value",
                    kServerNow),
        {correlation_id, vehicle_id, Version(), lease_s_, Blob(task)});
  });
  return number;
}

std::optional<OfferedJobState> OfferedJobs::Ask(std::int64_t number) {
  const std::lock_guard lock(mutex_);
  std::optional<OfferedJobState> state;
  database_->Query(
      fmt::format("UPDATE jobs SET wanted_until_unix_s = {0} + $3 WHERE number = $2 RETURNING"
                  " attempts, worker, stage, fraction, outcome,"
                  " CAST(taken_until_unix_s > {0} AS INTEGER) AS taken, {1} AS workers",
                  kServerNow, CountOfWorkers()),
      {Version(), number, lease_s_}, [&](const Row& row) {
        state.emplace();
        state->attempts = static_cast<int>(row.Integer("attempts"));
        state->taken = row.Integer("taken") != 0;
        state->worker = row.Text("worker");
        state->stage = row.Text("stage");
        state->fraction = row.Real("fraction");
        if (!row.IsNull("outcome")) state->outcome = row.Bytes("outcome");
        state->workers = static_cast<int>(row.Integer("workers"));
      });
  return state;
}

void OfferedJobs::Withdraw(std::int64_t number) {
  const std::lock_guard lock(mutex_);
  database_->Execute("DELETE FROM jobs WHERE number = $1", {number});
}

}  // namespace telltale
