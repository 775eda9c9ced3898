#pragma once

#include <memory>
#include <optional>

#include "data/samples.hpp"
#include "result.hpp"

namespace telltale {

/// Limits of one boat's sliding window. Every field is checked by Validate().
struct WindowLimits {
  double duration_s = 1200.0;              ///< kept time span, [10, 86400]
  std::size_t memory_bytes = 64u << 20;    ///< upper bound on stored samples, at least 64 KiB
  double reorder_tolerance_s = 0.5;        ///< a late sample this old is still put in place, [0, 10]
  double clock_jump_s = 60.0;              ///< a larger step in time is a jump, [1, 86400]
  std::size_t clock_jump_confirmations = 5;  ///< consistent samples after which the new clock is believed
  double stuck_after_s = 5.0;              ///< identical heading or position while commanded to move, [1, 600]

  /// The first field out of its range, as a refusal naming field, value and range.
  std::optional<Refusal> Validate() const;
};

/// The sliding window of one boat: takes raw samples in any order, keeps those that can be trusted,
/// counts the others by reason.
///
/// Assumes: one clock for the three channels. Not thread safe; the owner serialises access.
/// Cost: O(1) amortised per sample (late samples within the tolerance move a handful of neighbours).
/// Memory: bounded by duration_s and memory_bytes, whichever is reached first; the oldest go first.
class Window {
 public:
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
