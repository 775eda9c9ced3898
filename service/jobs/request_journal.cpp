#include "telltale/service/jobs/request_journal.hpp"

#include <chrono>
#include <cstdint>
#include <exception>
#include <iterator>
#include <string>
#include <string_view>
#include <utility>

#include <spdlog/spdlog.h>

#include "telltale/service/storage/stored_blob.hpp"
#include "telltale/service/storage/stores.hpp"
#include "telltale/service/unix_now.hpp"

namespace telltale {
namespace {

constexpr std::chrono::seconds kTryAgainPeriod{1};

bool HasPassed(const AnyRequest& request) {
  return std::visit([](const auto& kind) { return kind.deadline_s < 0.0; }, request);
}

/// Nothing where the row holds no request.
std::optional<AnyRequest> ReadRequest(const Row& row, const std::string& database) {
  const std::string bytes = row.Bytes("request");
  if (!HasChecksumOf(row, bytes)) {
    spdlog::error("{}: request {} is damaged and passed over", database,
                  row.Text("correlation_id"));
    return std::nullopt;
  }
  auto request = ParseStoredRequest(bytes, UnixNow());
  if (request) return std::move(*request);
  spdlog::error("{}: {}", database, request.error().Message());
  return std::nullopt;
}

}  // namespace

RequestJournal::RequestJournal(const Storage& storage)
    : storage_(storage), database_(storage.Open(RequestsSchema())) {}

RequestJournal::~RequestJournal() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  wake_.notify_all();
  if (thread_.joinable()) thread_.join();
}

std::vector<AnyRequest> RequestJournal::TakeUnanswered() {
  std::vector<AnyRequest> requests;
  std::vector<std::int64_t> dropped;
  database_->Query("SELECT * FROM requests ORDER BY number", {}, [&](const Row& row) {
    auto request = ReadRequest(row, database_->name());
    if (request && !HasPassed(*request)) {
      requests.push_back(*std::move(request));
    } else {
      dropped.push_back(row.Integer("number"));
    }
  });
  for (const std::int64_t number : dropped) {
    database_->Execute("DELETE FROM requests WHERE number = $1", {number});
  }
  thread_ = std::thread([this] { Run(); });
  return requests;
}

void RequestJournal::Keep(const AnyRequest& request, std::function<void()> kept) {
  const std::string& id = std::visit(
      [](const auto& kind) -> const std::string& { return kind.correlation_id; }, request);
  Push({id, SerialiseRequest(request, UnixNow()), std::move(kept)});
}

void RequestJournal::Drop(const std::string& correlation_id) {
  Push({correlation_id, "", {}});
}

void RequestJournal::Push(Entry entry) {
  {
    const std::lock_guard lock(mutex_);
    entries_.push_back(std::move(entry));
  }
  wake_.notify_all();
}

void RequestJournal::Run() {
  bool reachable = true;
  std::unique_lock lock(mutex_);
  while (!stopping_ || (reachable && !entries_.empty())) {
    wake_.wait_for(lock, kTryAgainPeriod,
                   [&] { return stopping_ || (reachable && !entries_.empty()); });
    if (entries_.empty() && !Unavailable()) continue;
    auto entries = std::exchange(entries_, {});
    lock.unlock();
    reachable = Write(entries);
    for (const Entry& entry : entries) {
      if (reachable && entry.kept) entry.kept();
    }
    lock.lock();
    if (reachable) continue;
    entries_.insert(entries_.begin(), std::make_move_iterator(entries.begin()),
                    std::make_move_iterator(entries.end()));
  }
}

bool RequestJournal::Write(const std::deque<Entry>& entries) {
  bool reachable = true;
  try {
    database_->InTransaction([&] {
      for (const Entry& entry : entries) Write(entry);
    });
    if (!wrote_last_time_) spdlog::info("requests are kept on disk again");
    wrote_last_time_ = true;
  } catch (const std::exception& error) {
    reachable = dynamic_cast<const DatabaseUnavailable*>(&error) == nullptr;
    if (wrote_last_time_) {
      spdlog::error("{}; requests are {}", error.what(),
                    reachable ? "worked on and not kept" : "answered as busy until it is back");
    }
    wrote_last_time_ = false;
  }
  return reachable;
}

void RequestJournal::Write(const Entry& entry) {
  if (entry.bytes.empty()) {
    database_->Execute("DELETE FROM requests WHERE correlation_id = $1", {entry.correlation_id});
    return;
  }
  database_->Execute(
      "INSERT INTO requests (correlation_id, request, checksum) VALUES ($1, $2, $3)"
      " ON CONFLICT (correlation_id) DO UPDATE SET request = excluded.request,"
      " checksum = excluded.checksum",
      {entry.correlation_id, Blob(entry.bytes), std::int64_t{ChecksumOf(entry.bytes)}});
}

}  // namespace telltale
