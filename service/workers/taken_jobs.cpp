#include "telltale/service/workers/taken_jobs.hpp"

#include <exception>
#include <utility>

#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include "telltale/core/base/version.hpp"
#include "telltale/service/storage/server_clock.hpp"
#include "telltale/service/storage/stores.hpp"

namespace telltale {
namespace {

// $1, $2 and $3: the number, the attempt and the worker.
constexpr std::string_view kIsMine =
    "number = $1 AND attempts = $2 AND worker = $3 AND outcome IS NULL";

}  // namespace

TakenJobs::TakenJobs(const Storage& storage, std::string worker, const WorkerSettings& settings)
    : database_(storage.Open(JobsSchema())), worker_(std::move(worker)), settings_(settings) {
  BeAlive();
}

TakenJobs::~TakenJobs() {
  try {
    database_->Execute("DELETE FROM workers WHERE worker = $1", {worker_});
  } catch (const std::exception& error) {
    spdlog::warn("{}; this worker counts as gone once its lease runs out", error.what());
  }
}

void TakenJobs::BeAlive() {
  const std::lock_guard lock(mutex_);
  database_->InTransaction([&] {
    database_->Execute(fmt::format("DELETE FROM workers WHERE until_unix_s <= {}", kServerNow));
    database_->Execute(
        fmt::format("INSERT INTO workers (worker, version, until_unix_s) VALUES ($1, $2, {} + $3)"
                    " ON CONFLICT (worker) DO UPDATE SET until_unix_s = excluded.until_unix_s",
                    kServerNow),
        {worker_, Version(), settings_.lease_s});
  });
}

std::optional<TakenJob> TakenJobs::Take() {
  const std::lock_guard lock(mutex_);
  std::optional<TakenJob> job;
  database_->InTransaction([&] {
    database_->Execute(fmt::format("DELETE FROM jobs WHERE wanted_until_unix_s <= {}", kServerNow));
    database_->Query(
        fmt::format(
            "UPDATE jobs SET attempts = attempts + 1, worker = $1, stage = '', fraction = 0,"
            " taken_until_unix_s = {0} + $2 WHERE number ="
            " (SELECT number FROM jobs WHERE outcome IS NULL AND version = $3"
            " AND taken_until_unix_s <= {0} AND attempts < $4"
            " ORDER BY number LIMIT 1 FOR UPDATE SKIP LOCKED)"
            " RETURNING number, attempts, correlation_id, vehicle_id, task",
            kServerNow),
        {worker_, settings_.lease_s, Version(), std::int64_t{settings_.attempts}},
        [&](const Row& row) {
          job = {{row.Integer("number"), row.Integer("attempts")},
                 row.Text("correlation_id"),
                 row.Text("vehicle_id"),
                 row.Bytes("task")};
        });
  });
  return job;
}

bool TakenJobs::Prolong(const JobClaim& job, std::string_view stage, double fraction) {
  const std::lock_guard lock(mutex_);
  return database_->Execute(
             fmt::format("UPDATE jobs SET taken_until_unix_s = {} + $4, stage = $5, fraction = $6"
                         " WHERE {}",
                         kServerNow, kIsMine),
             {job.number, job.attempt, worker_, settings_.lease_s, stage, fraction}) > 0;
}

bool TakenJobs::Answer(const JobClaim& job, std::string_view outcome) {
  const std::lock_guard lock(mutex_);
  return database_->Execute(fmt::format("UPDATE jobs SET outcome = $4 WHERE {}", kIsMine),
                            {job.number, job.attempt, worker_, Blob(outcome)}) > 0;
}

bool TakenJobs::GiveBack(const JobClaim& job) {
  const std::lock_guard lock(mutex_);
  return database_->Execute(
             fmt::format("UPDATE jobs SET attempts = attempts - 1, taken_until_unix_s = 0 WHERE {}",
                         kIsMine),
             {job.number, job.attempt, worker_}) > 0;
}

}  // namespace telltale
