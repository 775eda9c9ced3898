#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

namespace telltale {

/// The newest events of the fleet as server-sent events, for any number of readers. Each text is
/// made once and shared. Safe to use from several threads.
class EventLog {
 public:
  using Text = std::shared_ptr<const std::string>;

  struct Batch {
    std::uint64_t next = 0;  ///< where to read on
    std::vector<Text> events;
    bool closed = false;
  };

  /// Adds "event: NAME" with one line of data.
  void Add(const std::string& name, const std::string& data);

  /// Readers join before they read and leave after, so that nobody makes events for none.
  void Join() { ++readers_; }
  void Leave() { --readers_; }
  bool HasReaders() const { return readers_ > 0; }
  int readers() const { return readers_; }

  /// Where a new reader begins: after the newest event.
  std::uint64_t End() const;

  /// The events from `next` on; waits for at most `timeout` for the first. A reader that is too
  /// slow misses events, and reads on at the oldest that is kept.
  Batch Await(std::uint64_t next, std::chrono::milliseconds timeout);

  /// Ends every wait, now and later.
  void Close();

 private:
  static constexpr std::size_t kKept = 256;

  std::atomic<int> readers_ = 0;
  mutable std::mutex mutex_;
  std::condition_variable added_;
  std::deque<Text> kept_;
  std::uint64_t end_ = 0;  ///< number of the event after the newest
  bool closed_ = false;
};

}  // namespace telltale
