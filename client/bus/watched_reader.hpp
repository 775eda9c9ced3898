#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <utility>

#include "telltale/client/bus/reader.hpp"
#include "telltale/client/bus/wait_set.hpp"

namespace telltale {

/// A reader attached to a wait set for as long as it lives, and made anew when it is connected and
/// yet has heard nothing for `longest_silence`: one forged packet can silence a reliable reader for
/// ever while both sides still take it for connected. Belongs to the wait set's thread.
template <class Wire>
class WatchedReader {
 public:
  using Clock = std::chrono::steady_clock;

  WatchedReader(const Participant& participant, WaitSet& wait_set,
                std::function<void(const Wire&)> receive, std::chrono::nanoseconds longest_silence)
      : participant_(participant),
        wait_set_(wait_set),
        receive_(std::move(receive)),
        longest_silence_(longest_silence) {
    Open();
  }
  WatchedReader(const WatchedReader&) = delete;
  WatchedReader& operator=(const WatchedReader&) = delete;
  ~WatchedReader() { wait_set_.Detach(*reader_); }

  /// How many writers it is connected to.
  std::uint32_t Matched() const { return reader_->Matched(); }

  /// Makes the reader anew if it has been silent for too long; true when it did.
  bool ReopenIfSilent(Clock::time_point now) {
    if (reader_->Matched() == 0) last_received_ = now;
    if (now - last_received_ <= longest_silence_) return false;
    wait_set_.Detach(*reader_);
    Open();
    return true;
  }

 private:
  void Open() {
    reader_.emplace(participant_);
    last_received_ = Clock::now();
    wait_set_.Attach(*reader_, [this] {
      last_received_ = Clock::now();
      reader_->Take(receive_);
    });
  }

  const Participant& participant_;
  WaitSet& wait_set_;
  std::function<void(const Wire&)> receive_;
  std::chrono::nanoseconds longest_silence_;
  std::optional<Reader<Wire>> reader_;
  Clock::time_point last_received_;
};

}  // namespace telltale
