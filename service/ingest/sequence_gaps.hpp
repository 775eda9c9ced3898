#pragma once

#include <cstdint>

namespace telltale {

/// Loss seen through the sequence numbers of one channel of one vehicle.
class SequenceGaps {
 public:
  /// Notes the next sample to arrive.
  void Note(std::uint64_t sequence_number) {
    // A boat that starts anew counts from the beginning; so does a recording that is replayed.
    const bool restarted = sequence_number <= last_ || sequence_number - last_ > kLargestGap;
    if (last_ != 0 && !restarted) lost_ += sequence_number - last_ - 1;
    last_ = sequence_number;
  }

  std::uint64_t lost() const { return lost_; }

 private:
  static constexpr std::uint64_t kLargestGap =
      1'000'000;  // hours of silence; anything more is no count

  std::uint64_t last_ = 0;
  std::uint64_t lost_ = 0;
};

}  // namespace telltale
