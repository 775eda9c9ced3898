#include "telltale/service/jobs/request_journal.hpp"

#include <cstdint>
#include <exception>
#include <string>
#include <string_view>
#include <utility>

#include <SQLiteCpp/SQLiteCpp.h>
#include <spdlog/spdlog.h>

#include "telltale/service/storage/database.hpp"
#include "telltale/service/unix_now.hpp"

namespace telltale {
namespace {

void CreateRequests(SQLite::Database& database) {
  UseWriteAheadLog(database, "FULL");
  database.exec(
      "CREATE TABLE IF NOT EXISTS requests ("
      "  number INTEGER PRIMARY KEY AUTOINCREMENT, correlation_id TEXT NOT NULL UNIQUE,"
      "  request BLOB NOT NULL)");  // proto/stored_request.proto, serialised
}

bool HasPassed(const AnyRequest& request) {
  return std::visit([](const auto& kind) { return kind.deadline_s < 0.0; }, request);
}

}  // namespace

RequestJournal::RequestJournal(const std::filesystem::path& directory)
    : database_(OpenOrSalvage(directory / "requests.sqlite", CreateRequests, {"requests"})) {}

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
  {
    SQLite::Statement rows(*database_, "SELECT request, number FROM requests ORDER BY number");
    while (rows.executeStep()) {
      const SQLite::Column blob = rows.getColumn(0);
      auto request = ParseStoredRequest(
          {static_cast<const char*>(blob.getBlob()), static_cast<std::size_t>(blob.getBytes())},
          UnixNow());
      if (!request) spdlog::error("requests.sqlite: {}", request.error().Message());
      if (request && !HasPassed(*request)) {
        requests.push_back(*std::move(request));
      } else {
        dropped.push_back(rows.getColumn(1).getInt64());
      }
    }
  }
  for (const std::int64_t number : dropped) {
    database_->exec("DELETE FROM requests WHERE number = " + std::to_string(number));
  }
  thread_ = std::thread([this] { Run(); });
  return requests;
}

void RequestJournal::Keep(const AnyRequest& request, std::function<void()> kept) {
  Push({CorrelationIdOf(request), SerialiseRequest(request, UnixNow()), std::move(kept)});
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
  std::unique_lock lock(mutex_);
  while (!stopping_ || !entries_.empty()) {
    wake_.wait(lock, [this] { return stopping_ || !entries_.empty(); });
    const auto entries = std::exchange(entries_, {});
    lock.unlock();
    Write(entries);
    for (const Entry& entry : entries) {
      if (entry.kept) entry.kept();
    }
    lock.lock();
  }
}

void RequestJournal::Commit(const std::deque<Entry>& entries) {
  SQLite::Transaction transaction(*database_, SQLite::TransactionBehavior::IMMEDIATE);
  for (const Entry& entry : entries) {
    const bool kept = !entry.bytes.empty();
    SQLite::Statement change(
        *database_, kept ? "INSERT OR REPLACE INTO requests (correlation_id, request) VALUES (?, ?)"
                         : "DELETE FROM requests WHERE correlation_id = ?");
    change.bind(1, entry.correlation_id);
    if (kept) change.bind(2, entry.bytes.data(), static_cast<int>(entry.bytes.size()));
    change.exec();
  }
  transaction.commit();
}

void RequestJournal::Write(const std::deque<Entry>& entries) {
  try {
    written_.Count([&] { Commit(entries); });
    if (!wrote_last_time_) spdlog::info("requests are kept on disk again");
    wrote_last_time_ = true;
  } catch (const std::exception& error) {
    if (wrote_last_time_) {
      spdlog::error("requests.sqlite: {}; requests are worked on and not kept", error.what());
    }
    wrote_last_time_ = false;
  }
}

}  // namespace telltale
