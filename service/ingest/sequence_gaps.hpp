#pragma once

#include <cstdint>

namespace telltale {

/// The number of samples lost, by the gaps in the sequence numbers of one channel of one vehicle.
class SequenceGaps {
 public:
  /// Adds the next sample to arrive.
  void Note(std::uint64_t sequence_number) {
    // A vehicle that restarts counts from the beginning, and so does a replayed recording.
    const bool restarted = sequence_number <= last_ || sequence_number - last_ > kLargestGap;
    if (last_ != 0 && !restarted) lost_ += sequence_number - last_ - 1;
    last_ = sequence_number;
  }

  std::uint64_t lost() const { return lost_; }

 private:
  // A larger step is a restart: at ten samples a second it would be a day of loss.
  static constexpr std::uint64_t kLargestGap = 1'000'000;

  std::uint64_t last_ = 0;
  std::uint64_t lost_ = 0;
};

}  // namespace telltale
