#pragma once

#include <cstddef>
#include <memory>
#include <optional>

#include "telltale/core/base/result.hpp"
#include "telltale/core/data/samples.hpp"

namespace telltale {

/// Limits of one boat's sliding window. Every field is checked by Validate().
struct WindowLimits {
  double duration_s = 1200.0;            ///< time span kept behind the newest sample, [10, 86400]
  std::size_t memory_bytes = 64u << 20;  ///< upper bound on stored samples, kLeastMemory and more
  double reorder_tolerance_s = 0.5;      ///< a late sample this old is put in place, [0, 10]
  double clock_jump_s = 60.0;            ///< a larger step in time is a jump, [1, 86400]
  std::size_t clock_jump_confirmations = 5;  ///< samples that confirm a new clock, [1, 1000]
  double stuck_after_s = 5.0;  ///< commanded time an unchanged reading may last, [1, 600]

  static constexpr std::size_t kLeastMemory = 64u << 10;

  /// The first field out of its range, as a refusal naming field, value and range.
  std::optional<Refusal> Validate() const;
};

/// The sliding window of one boat. It takes raw samples in any order, keeps the valid ones and
/// counts the others by reason. Every sample is either kept or counted.
///
/// Order: a sample up to reorder_tolerance_s older than the newest of its channel is put in place,
/// an older one is kOutOfOrder; one with the time of a held sample of its channel is kDuplicate.
///
/// Clock: a sample more than clock_jump_s from the newest of any channel is kClockJump, until
/// clock_jump_confirmations consecutive samples of that kind agree and their stamps advance. They
/// confirm a new clock. After a jump ahead, as after a long radio silence, the held samples stay
/// and later steps see a gap. After a jump back, as when a boat restarts its clock, they are
/// dropped. A single wrong stamp less than clock_jump_s ahead makes its channel kOutOfOrder for
/// that long at most. The samples of the former clock are kept aside until stamps of the new one
/// span more than clock_jump_s. Until then a return to the former clock, confirmed likewise, drops
/// the samples of the new clock and gives those of the former back.
///
/// Stuck sensors: a heading or position repeated bit for bit is kStuckSensor once the pulse widths
/// have differed for more than stuck_after_s in all, by more than 50 us on a side, from those at
/// the start of the repetition. A boat at rest under constant commands may repeat its position
/// without limit.
///
/// Assumes: one clock for the three channels. Not thread safe; the owner serialises access.
/// Cost: O(1) amortised per sample (late samples within the tolerance move a handful of
/// neighbours). Memory: bounded by duration_s and memory_bytes, whichever is reached first; the
/// oldest go first. Twice that while a new clock settles.
class Window {
 public:
  /// Requires: limits that pass Validate().
  explicit Window(WindowLimits limits);
  ~Window();
  Window(Window&&) noexcept;
  Window& operator=(Window&&) noexcept;

  /// Nothing when the sample is kept, else the reason for its rejection.
  std::optional<RejectReason> Add(const GnssFix& fix);
  std::optional<RejectReason> Add(const HeadingSample& sample);
  std::optional<RejectReason> Add(const ThrusterSample& sample);

  Recording Snapshot() const;

  /// Of each channel the samples of the last `duration_s` before EndTime().
  Recording Snapshot(double duration_s) const;

  /// The same, given away, so that the samples stand in memory once. The window is empty then.
  Recording Release() &&;

  /// Another bound instead of WindowLimits::memory_bytes, kLeastMemory and more; the oldest samples
  /// beyond it go at once.
  void LimitMemory(std::size_t memory_bytes);

  /// Memory of the samples that Snapshot() gives.
  std::size_t StoredBytes() const;

  std::size_t Size(Channel channel) const;
  double StartTime() const;  ///< oldest kept sample of any channel; 0 when empty
  double EndTime() const;    ///< newest kept sample of any channel; 0 when empty
  bool Empty() const;
  const RejectCounts& Rejected() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace telltale
