#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "telltale/idl/codec/stored_request.hpp"
#include "telltale/service/storage/storage.hpp"
#include "telltale/service/storage/write_durations.hpp"

namespace telltale {

/// A request of a run before that has no answer.
struct UnansweredRequest {
  AnyRequest request;
  /// How often a daemon that took it up again, or that another has replaced, has begun it and ended
  /// before it. Two daemons that stand in for each other count into one sum, each in its own
  /// journal: each counts its own attempts and, when it takes over, that of the other.
  int attempts = 0;
};

/// The requests that wait for their answers, in the storage, so that a daemon that was killed
/// finishes them after its restart. A thread of its own writes what has come together in one
/// transaction. A fault of the disk is logged: requests are then worked on without being kept. A
/// database that cannot be reached is tried again once a second, and gets everything in its order.
/// While it hangs, no more waits than the requests without an answer and the answers to those that
/// it has: a request that is answered before it is written is not written at all.
/// Safe to use from several threads.
class RequestJournal {
 public:
  /// Throws DatabaseError where the database cannot be opened.
  explicit RequestJournal(const Storage& storage);
  RequestJournal(const RequestJournal&) = delete;
  RequestJournal& operator=(const RequestJournal&) = delete;
  ~RequestJournal();  ///< writes what has come, and ends the thread

  /// The requests of a run before, oldest first, that somebody may still wait for: all, or those
  /// about the boats of these slices. Those whose deadline has passed are dropped. The others stay
  /// on disk until Drop().
  std::vector<UnansweredRequest> TakeUnanswered(const std::optional<std::set<int>>& slices = {});

  /// The work on a request begins. One of a run before has its attempt counted on disk first, since
  /// it may be what has ended that run. Where the disk refuses, that is logged.
  void CountAttempt(const std::string& correlation_id);

  /// Another daemon that stood in for this one had begun the request and ended before it: it is
  /// kept as one of a run before, with that attempt. Returns its attempts so far; 1 where the disk
  /// refuses, which is logged.
  int CountAttemptOfAnother(const AnyRequest& request);

  /// Why the database cannot be reached now, so that no request can be kept; nothing where it can.
  std::optional<std::string> Unavailable() const { return storage_.status().Unavailable(); }

  /// `kept` runs on the thread of the journal once the request is on disk, or where a fault of the
  /// disk keeps it from there.
  void Keep(const AnyRequest& request, std::function<void()> kept);

  /// The request needs no answer any more, where this daemon still serves its boat.
  void Drop(const std::string& correlation_id);

  /// How many requests, and answers to requests that are kept, wait to be written.
  std::size_t Waiting() const;

  WriteDurations::Sum Written() const { return written_.Total(); }

 private:
  struct Entry {
    std::string correlation_id;
    int slice = 0;      ///< of its boat
    std::string bytes;  ///< empty: it is dropped
    std::function<void()> kept;
    bool may_be_stored = false;  ///< so that dropping it has to be written
  };

  void Run();
  int SliceOfRequest(const AnyRequest& request) const;
  bool Write(std::deque<Entry>& entries);  ///< false where the database cannot be reached
  void WriteHeld(std::deque<Entry>& entries);
  void Write(const Entry& entry);
  void Push(Entry entry);
  std::deque<Entry>::iterator FindUnwritten(const std::string& correlation_id);

  const Storage storage_;
  std::unique_ptr<Database> database_;  // of the thread, once that runs
  bool wrote_last_time_ = true;
  WriteDurations written_;
  mutable std::mutex mutex_;  // of what follows
  std::condition_variable wake_;
  bool stopping_ = false;
  std::deque<Entry> entries_;
  std::map<std::string, int> kept_;  ///< the slice of each request until it is dropped
  std::set<std::string> taken_up_;   ///< those of kept_ that are of a run before
  std::thread thread_;
};

}  // namespace telltale
