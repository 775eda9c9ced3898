#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

namespace telltale {

/// One GNSS position of the antenna. Time in seconds of the boat's clock (any epoch).
struct GnssFix {
  double time_s = 0.0;
  double latitude_deg = 0.0;   ///< [-90, 90]
  double longitude_deg = 0.0;  ///< [-180, 180]
};

/// One true heading, clockwise from north, any wrap.
struct HeadingSample {
  double time_s = 0.0;
  double heading_deg = 0.0;  ///< [-360, 720]
};

/// The pulse widths sent to both thrusters (port = left).
struct ThrusterSample {
  double time_s = 0.0;
  double port_us = 0.0;       ///< [500, 2500]
  double starboard_us = 0.0;  ///< [500, 2500]
};

/// Whether two readings are alike to the last bit, whatever their times.
inline bool SameReading(const GnssFix& a, const GnssFix& b) {
  return a.latitude_deg == b.latitude_deg && a.longitude_deg == b.longitude_deg;
}
inline bool SameReading(const HeadingSample& a, const HeadingSample& b) {
  return a.heading_deg == b.heading_deg;
}

enum class Channel { kGnss, kHeading, kThrusters };

inline constexpr std::array kChannels = {Channel::kGnss, Channel::kHeading, Channel::kThrusters};

/// The reason for which a sample is rejected.
enum class RejectReason {
  kNotFinite,    ///< NaN or infinity in a field
  kOutOfRange,   ///< a finite value outside the field's range
  kDuplicate,    ///< same time as a sample already held
  kOutOfOrder,   ///< older than the newest by more than the tolerance
  kClockJump,    ///< time jumps ahead or back by more than the jump limit
  kStuckSensor,  ///< a reading that repeats bit for bit while the commands change
  kRepeated,     ///< a log's copy of the last reading of a sensor that is slower than the log
};

inline constexpr std::array kRejectReasons = {RejectReason::kNotFinite, RejectReason::kOutOfRange,
                                              RejectReason::kDuplicate, RejectReason::kOutOfOrder,
                                              RejectReason::kClockJump, RejectReason::kStuckSensor,
                                              RejectReason::kRepeated};

std::string_view Name(Channel channel);
std::string_view Name(RejectReason reason);

/// The channel of this name; nothing where there is none.
std::optional<Channel> ChannelNamed(std::string_view name);

/// Rejected samples by channel and reason.
class RejectCounts {
 public:
  void Count(Channel channel, RejectReason reason) { ++At(channel, reason); }
  void Count(Channel channel, RejectReason reason, std::uint64_t n) { At(channel, reason) += n; }
  std::uint64_t Of(Channel channel, RejectReason reason) const {
    return counts_[CellOf(channel, reason)];
  }
  std::uint64_t Of(RejectReason reason) const;
  std::uint64_t Total() const;
  void Add(const RejectCounts& other);

 private:
  static std::size_t CellOf(Channel channel, RejectReason reason) {
    return static_cast<std::size_t>(channel) * kRejectReasons.size() +
           static_cast<std::size_t>(reason);
  }
  std::uint64_t& At(Channel channel, RejectReason reason) {
    return counts_[CellOf(channel, reason)];
  }

  std::array<std::uint64_t, kChannels.size() * kRejectReasons.size()> counts_{};
};

/// A copy of the samples of a window or a log: each channel in order of time, without duplicates.
struct Recording {
  std::vector<GnssFix> gnss;
  std::vector<HeadingSample> heading;
  std::vector<ThrusterSample> thrusters;
  RejectCounts rejected;
  /// Where it joins several recordings with gaps between them: the time at which each begins,
  /// ascending. Empty: one recording.
  std::vector<double> starts_s = {};
};

}  // namespace telltale
