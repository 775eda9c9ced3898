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
  std::size_t memory_bytes = 64u << 20;  ///< upper bound on stored samples, at least 64 KiB
  double reorder_tolerance_s = 0.5;      ///< a late sample this old is put in place, [0, 10]
  double clock_jump_s = 60.0;            ///< a larger step in time is a jump, [1, 86400]
  std::size_t clock_jump_confirmations = 5;  ///< samples that make a new clock believed, [1, 1000]
  double stuck_after_s = 5.0;  ///< commanded time an unchanged reading may last, [1, 600]

  /// The first field out of its range, as a refusal naming field, value and range.
  std::optional<Refusal> Validate() const;
};

/// The sliding window of one boat: takes raw samples in any order, keeps those that can be trusted,
/// counts the others by reason. Every sample is either kept or counted.
///
/// Order: a sample up to reorder_tolerance_s older than the newest of its channel is put in place,
/// an older one is kOutOfOrder; one with the time of a held sample of its channel is kDuplicate.
///
/// Clock: a sample more than clock_jump_s from the newest of any channel is kClockJump, until
/// clock_jump_confirmations such samples in a row agree with each other and their stamps run
/// forward. The new clock is then believed: after a leap ahead the held samples stay, behind what
/// is for all later steps a gap, so that a long radio silence costs nothing; after a leap back, as
/// when a boat restarts its clock, they are dropped. A wild stamp short of clock_jump_s ahead shuts
/// its channel for at most that long, visibly as kOutOfOrder.
///
/// Stuck sensors: a heading or position repeated bit for bit is kStuckSensor once the pulse widths
/// have been away (by more than 50 us on a side) from what they were when the repetition began for
/// more than stuck_after_s in all. A window knows no neutral pulse width; it does know that a boat
/// whose commands changed for so long cannot read exactly what it read before. A boat at rest under
/// steady commands may repeat its position for ever.
///
/// Assumes: one clock for the three channels. Not thread safe; the owner serialises access.
/// Cost: O(1) amortised per sample (late samples within the tolerance move a handful of
/// neighbours). Memory: bounded by duration_s and memory_bytes, whichever is reached first; the
/// oldest go first.
class Window {
 public:
  /// Requires: limits that pass Validate().
  explicit Window(WindowLimits limits);
  ~Window();
  Window(Window&&) noexcept;
  Window& operator=(Window&&) noexcept;

  /// Nothing when the sample was kept, else why it was set aside.
  std::optional<RejectReason> Add(const GnssFix& fix);
  std::optional<RejectReason> Add(const HeadingSample& sample);
  std::optional<RejectReason> Add(const ThrusterSample& sample);

  Recording Snapshot() const;

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
