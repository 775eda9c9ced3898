#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

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

  /// `receive` as that of Reader::Take().
  template <class Receive>
  WatchedReader(const Participant& participant, WaitSet& wait_set, Receive receive,
                std::chrono::nanoseconds longest_silence)
      : participant_(participant),
        wait_set_(wait_set),
        take_([receive](Reader<Wire>& reader) { reader.Take(receive); }),
        longest_silence_(longest_silence) {
    Open();
  }
  WatchedReader(const WatchedReader&) = delete;
  WatchedReader& operator=(const WatchedReader&) = delete;
  ~WatchedReader() { wait_set_.Detach(*reader_); }

  /// How many writers it is connected to.
  std::uint32_t Matched() const { return reader_->Matched(); }

  /// As those of the reader.
  std::set<WriterHandle> Writers() const { return reader_->Writers(); }
  std::vector<std::string> PartitionsOf(WriterHandle writer) const {
    return reader_->PartitionsOf(writer);
  }

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
      take_(*reader_);
    });
  }

  const Participant& participant_;
  WaitSet& wait_set_;
  const std::function<void(Reader<Wire>&)> take_;
  std::chrono::nanoseconds longest_silence_;
  std::optional<Reader<Wire>> reader_;
  Clock::time_point last_received_;
};

}  // namespace telltale
