#pragma once

#include <condition_variable>
#include <deque>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "telltale/idl/codec/stored_request.hpp"
#include "telltale/service/storage/write_durations.hpp"

namespace SQLite {
class Database;
}

namespace telltale {

/// The requests that wait for their answers, in requests.sqlite of the state directory, so that a
/// daemon that was killed finishes them after its restart. A thread of its own writes what has come
/// together in one transaction. A fault of the disk is logged: requests are then worked on without
/// being kept. Safe to use from several threads.
class RequestJournal {
 public:
  /// Throws SQLite::Exception where the database cannot be opened.
  explicit RequestJournal(const std::filesystem::path& directory);
  RequestJournal(const RequestJournal&) = delete;
  RequestJournal& operator=(const RequestJournal&) = delete;
  ~RequestJournal();  ///< writes what has come, and ends the thread

  /// The requests of the run before, oldest first, that somebody may still wait for. Those whose
  /// deadline has passed are dropped. The others stay on disk until Drop(). Call it once.
  std::vector<AnyRequest> TakeUnanswered();

  /// `kept` runs on the thread of the journal once the request is on disk.
  void Keep(const AnyRequest& request, std::function<void()> kept);

  /// The request needs no answer any more.
  void Drop(const std::string& correlation_id);

  WriteDurations::Sum Written() const { return written_.Total(); }

 private:
  struct Entry {
    std::string correlation_id;
    std::string bytes;  ///< empty: it is dropped
    std::function<void()> kept;
  };

  void Run();
  void Write(const std::deque<Entry>& entries);
  void Commit(const std::deque<Entry>& entries);
  void Push(Entry entry);

  std::unique_ptr<SQLite::Database> database_;  // of the thread, once that runs
  bool wrote_last_time_ = true;
  WriteDurations written_;
  std::mutex mutex_;  // of what follows
  std::condition_variable wake_;
  bool stopping_ = false;
  std::deque<Entry> entries_;
  std::thread thread_;
};

}  // namespace telltale
