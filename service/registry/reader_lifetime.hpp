#pragma once

#include <chrono>
#include <cstddef>

namespace telltale {

/// How long a reader of announcements lives before a new one takes its place. Each id that it has
/// heard takes memory until then, also that of a boat that is gone.
class ReaderLifetime {
 public:
  using Time = std::chrono::steady_clock::time_point;

  // Boats that are gone make place for others by then, and to hear all anew takes a second.
  static constexpr std::chrono::minutes kOfFull{10};
  // Ids that are only retired may come by the thousand each second.
  static constexpr std::chrono::minutes kLeast{1};

  /// `most`: so many ids without a boat the reader keeps.
  ReaderLifetime(std::size_t most, Time begun) : most_(most), begun_(begun) {}

  /// The reader has heard of as many boats as it may.
  void NoteFull() { is_full_ = true; }

  /// An id is retired of which the reader knew no boat.
  void NoteUnknownRetired() { ++unknown_retired_; }

  bool IsOver(Time now) const {
    const auto age = now - begun_;
    return (is_full_ && age >= kOfFull) || (unknown_retired_ > most_ && age >= kLeast);
  }

 private:
  std::size_t most_;
  Time begun_;
  bool is_full_ = false;
  std::size_t unknown_retired_ = 0;
};

}  // namespace telltale
