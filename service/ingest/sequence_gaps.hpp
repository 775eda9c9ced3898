#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>

namespace telltale {

/// The number of samples lost, by the gaps in the sequence numbers of one channel of one vehicle.
/// A gap counts once the next samples confirm it: a forged number, and a publisher that starts
/// anew, leave gaps that nothing follows. No channel loses more samples than it can send in the
/// time between the stamps on both sides of the gap: at 200 Hz, or at twice the rate at which its
/// latest 64 samples or more came, whichever is more.
class SequenceGaps {
 public:
  /// Adds the next sample to arrive, with its stamp.
  void Note(std::uint64_t sequence_number, double time_s) {
    const Sample sample{sequence_number, time_s};
    if (!last_) {
      last_ = rate_since_ = sample;
    } else if (Follows(sample, *last_)) {
      Advance(sample);
      gap_.reset();
    } else {
      NoteGap(sample);
    }
  }

  std::uint64_t lost() const { return lost_; }

 private:
  struct Sample {
    std::uint64_t number = 0;
    double time_s = 0.0;
  };
  /// A series of samples that does not follow the last one.
  struct Gap {
    Sample first;
    Sample newest;
    int length = 1;
  };

  static constexpr std::uint64_t kSmallGap = 64;  ///< what a reader holds: a burst may be lost
  static constexpr int kConfirmations = 5;
  static constexpr double kUsualRateHz = 200.0;
  static constexpr double kHighestRateHz = 20'000.0;  ///< of two stamps that are close by chance

  static bool Follows(const Sample& next, const Sample& last) {
    return next.number > last.number && next.number - last.number <= kSmallGap;
  }

  void Advance(const Sample& sample) {
    lost_ += sample.number - last_->number - 1;
    last_ = sample;
    NoteRate(sample);
  }

  void NoteRate(const Sample& sample) {
    const std::uint64_t sent = sample.number - rate_since_.number;
    if (sent < kSmallGap) return;
    const double lasted_s = sample.time_s - rate_since_.time_s;
    if (lasted_s > 0.0) {
      rate_hz_ = std::min(static_cast<double>(sent) / lasted_s, kHighestRateHz);
    }
    rate_since_ = sample;
  }

  void NoteGap(const Sample& sample) {
    if (gap_ && Follows(sample, gap_->newest)) {
      gap_->newest = sample;
      ++gap_->length;
    } else {
      gap_ = Gap{sample, sample};
    }
    if (gap_->length < kConfirmations) return;
    lost_ += MissingBefore(gap_->first);
    lost_ += gap_->newest.number - gap_->first.number + 1 - kConfirmations;
    last_ = rate_since_ = gap_->newest;
    gap_.reset();
  }

  /// None where the numbers went back: the publisher counts from the beginning again.
  std::uint64_t MissingBefore(const Sample& sample) const {
    if (sample.number <= last_->number) return 0;
    const double missing = static_cast<double>(sample.number - last_->number - 1);
    const double sendable =
        std::max(kUsualRateHz, 2.0 * rate_hz_) * std::max(sample.time_s - last_->time_s, 0.0);
    return missing <= sendable ? sample.number - last_->number - 1 : 0;
  }

  std::optional<Sample> last_;
  Sample rate_since_;
  double rate_hz_ = 0.0;  ///< 0: not known yet
  std::optional<Gap> gap_;
  std::uint64_t lost_ = 0;
};

}  // namespace telltale
