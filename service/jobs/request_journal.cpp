#include "telltale/service/jobs/request_journal.hpp"

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <exception>
#include <iterator>
#include <string>
#include <string_view>
#include <utility>

#include <spdlog/spdlog.h>

#include "telltale/client/fleet/unix_now.hpp"
#include "telltale/service/storage/stored_blob.hpp"
#include "telltale/service/storage/stores.hpp"

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

/// 0 for a request that a program without slices has kept.
int SliceOfRow(const Row& row) {
  return row.IsNull("slice") ? 0 : static_cast<int>(row.Integer("slice"));
}

}  // namespace

RequestJournal::RequestJournal(const Storage& storage)
    : storage_(storage), database_(storage.Open(RequestsSchema())), thread_([this] { Run(); }) {}

RequestJournal::~RequestJournal() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  wake_.notify_all();
  thread_.join();
}

/// By a connection of its own, since the other is the thread's.
std::vector<UnansweredRequest> RequestJournal::TakeUnanswered(
    const std::optional<std::set<int>>& slices) {
  const auto database = storage_.Open(RequestsSchema());
  std::vector<UnansweredRequest> requests;
  std::vector<std::int64_t> dropped;
  database->Query("SELECT * FROM requests ORDER BY number", {}, [&](const Row& row) {
    if (slices && !slices->contains(SliceOfRow(row))) return;
    auto request = ReadRequest(row, database->name());
    if (request && !HasPassed(*request)) {
      const std::lock_guard lock(mutex_);
      kept_.insert_or_assign(row.Text("correlation_id"), SliceOfRow(row));
      taken_up_.insert(row.Text("correlation_id"));
      requests.push_back({*std::move(request), static_cast<int>(row.Integer("attempts"))});
    } else {
      dropped.push_back(row.Integer("number"));
    }
  });
  for (const std::int64_t number : dropped) {
    database->Execute("DELETE FROM requests WHERE number = $1", {number});
  }
  return requests;
}

/// By a connection of its own, since the thread may be waiting with the other.
void RequestJournal::CountAttempt(const std::string& correlation_id) {
  {
    const std::lock_guard lock(mutex_);
    if (!taken_up_.contains(correlation_id)) return;
  }
  try {
    storage_.Open(RequestsSchema())
        ->Execute("UPDATE requests SET attempts = attempts + 1 WHERE correlation_id = $1",
                  {correlation_id});
  } catch (const DatabaseError& error) {
    spdlog::error("{}; the attempt to answer {} is not counted", error.what(), correlation_id);
  }
}

int RequestJournal::CountAttemptOfAnother(const AnyRequest& request) {
  const std::string& id = CorrelationIdOf(request);
  const int slice = SliceOfRequest(request);
  const std::string bytes = SerialiseRequest(request, UnixNow());
  {
    const std::lock_guard lock(mutex_);
    kept_.insert_or_assign(id, slice);
    taken_up_.insert(id);
  }
  int attempts = 1;
  try {
    storage_.Open(RequestsSchema())
        ->Query(
            "INSERT INTO requests (correlation_id, request, checksum, slice, attempts)"
            " VALUES ($1, $2, $3, $4, 1) ON CONFLICT (correlation_id)"
            " DO UPDATE SET attempts = requests.attempts + 1 RETURNING attempts",
            {id, Blob(bytes), std::int64_t{ChecksumOf(bytes)}, std::int64_t{slice}},
            [&](const Row& row) { attempts = static_cast<int>(row.Integer("attempts")); });
  } catch (const DatabaseError& error) {
    spdlog::error("{}; the attempt of another daemon to answer {} is not counted", error.what(),
                  id);
  }
  return attempts;
}

void RequestJournal::Keep(const AnyRequest& request, std::function<void()> kept) {
  const std::string& id = CorrelationIdOf(request);
  Entry entry{id, SliceOfRequest(request), SerialiseRequest(request, UnixNow()), std::move(kept)};
  {
    const std::lock_guard lock(mutex_);
    entry.may_be_stored = !kept_.insert_or_assign(id, entry.slice).second;
    if (const auto earlier = FindUnwritten(id); earlier != entries_.end()) {
      entry.may_be_stored = earlier->may_be_stored;
      *earlier = std::move(entry);
      return;
    }
  }
  Push(std::move(entry));
}

void RequestJournal::Drop(const std::string& correlation_id) {
  std::unique_lock lock(mutex_);
  const auto kept = kept_.extract(correlation_id);
  if (kept.empty()) return;
  taken_up_.erase(correlation_id);
  const auto unwritten = FindUnwritten(correlation_id);
  if (unwritten != entries_.end() && !unwritten->may_be_stored) {
    entries_.erase(unwritten);
    return;
  }
  lock.unlock();
  Push({correlation_id, kept.mapped(), "", {}});
}

std::size_t RequestJournal::Waiting() const {
  const std::lock_guard lock(mutex_);
  return entries_.size();
}

/// The request that waits to be written, unless its answer waits too. The caller holds mutex_.
std::deque<RequestJournal::Entry>::iterator RequestJournal::FindUnwritten(
    const std::string& correlation_id) {
  const auto last = std::find_if(entries_.rbegin(), entries_.rend(), [&](const Entry& entry) {
    return entry.correlation_id == correlation_id;
  });
  const bool is_request = last != entries_.rend() && !last->bytes.empty();
  return is_request ? std::prev(last.base()) : entries_.end();
}

/// A refresh is of no boat in particular: it goes with any slice that this daemon holds.
int RequestJournal::SliceOfRequest(const AnyRequest& request) const {
  if (const auto* identify = std::get_if<IdentifyRequest>(&request)) {
    return SliceOf(identify->vehicle_id);
  }
  if (const auto* diagnose = std::get_if<DiagnoseRequest>(&request)) {
    return SliceOf(diagnose->vehicle_id);
  }
  const Slices held = storage_.held() == nullptr ? Slices() : storage_.held()->Get();
  return held.empty() ? 0 : held.begin()->first;
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
    for (Entry& entry : entries) entry.may_be_stored = true;  // what was being committed may be
    entries_.insert(entries_.begin(), std::make_move_iterator(entries.begin()),
                    std::make_move_iterator(entries.end()));
  }
}

bool RequestJournal::Write(std::deque<Entry>& entries) {
  bool reachable = true;
  try {
    written_.Count([&] { database_->InTransaction([&] { WriteHeld(entries); }); });
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

/// Who asks for a boat that another daemon serves now hears nothing from here, and asks again.
void RequestJournal::WriteHeld(std::deque<Entry>& entries) {
  std::set<int> slices;
  for (const Entry& entry : entries) slices.insert(entry.slice);
  const std::set<int> held = storage_.LockLeases(*database_, slices);
  for (Entry& entry : entries) {
    held.contains(entry.slice) ? Write(entry) : void(entry.kept = {});
  }
}

void RequestJournal::Write(const Entry& entry) {
  if (entry.bytes.empty()) {
    database_->Execute("DELETE FROM requests WHERE correlation_id = $1", {entry.correlation_id});
    return;
  }
  database_->Execute(
      "INSERT INTO requests (correlation_id, request, checksum, slice) VALUES ($1, $2, $3, $4)"
      " ON CONFLICT (correlation_id) DO UPDATE SET request = excluded.request,"
      " checksum = excluded.checksum, slice = excluded.slice",
      {entry.correlation_id, Blob(entry.bytes), std::int64_t{ChecksumOf(entry.bytes)},
       std::int64_t{entry.slice}});
}

}  // namespace telltale
