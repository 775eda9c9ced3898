#pragma once

#include <array>
#include <chrono>
#include <cstdint>

#include "telltale/core/data/samples.hpp"

namespace telltale {

/// The samples of each channel: gnss, heading, thrusters.
using ChannelCounts = std::array<std::uint64_t, kChannels.size()>;

/// The share of each channel that is taken in, [0, 1], in the same order.
using ChannelShares = std::array<double, kChannels.size()>;

/// The shares by which at most `most` of the samples that arrive are taken in. Headings are thinned
/// first, to one in ten; then positions, to one in five; then commands, to one in two. Where that
/// is not enough, all are thinned further by the same factor, so that no channel falls silent.
ChannelShares SharesWithin(double most, const ChannelCounts& arriving);

/// Picks a share of a stream evenly: of a share of 0.2 it keeps every fifth sample.
class Thinner {
 public:
  /// Whether the next sample is kept. Requires: a share in [0, 1].
  bool Keep(double share) {
    due_ += share;
    if (due_ < 1.0) return false;
    due_ -= 1.0;
    return true;
  }

 private:
  double due_ = 0.0;
};

using ChannelThinners = std::array<Thinner, kChannels.size()>;

/// How many samples a second are taken in. The shares follow the rates of the last second, or of
/// the time in which as many samples came as a second may bring. Not thread safe.
class RateBound {
 public:
  using Clock = std::chrono::steady_clock;
  enum class Change { kNone, kBeginsToThin, kEndsToThin };

  explicit RateBound(double most_per_s);

  /// Counts a sample that arrives at `now`. It ends to thin once everything has fitted for 10 s.
  Change Count(Channel channel, Clock::time_point now);

  double ShareOf(Channel channel) const { return shares_[static_cast<std::size_t>(channel)]; }
  double most_per_s() const { return most_per_s_; }
  double arriving_per_s() const { return arriving_per_s_; }

 private:
  Change Renew(Clock::time_point now);

  double most_per_s_;
  double arriving_per_s_ = 0.0;
  Clock::time_point since_{};  ///< of what is counted
  ChannelCounts counts_{};
  double counted_ = 0.0;  ///< of all channels
  ChannelShares shares_;
  bool thins_ = false;
  Clock::time_point thinned_at_{};
};

}  // namespace telltale
