#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string_view>

#include "telltale/client/bridge/channel_choice.hpp"
#include "telltale/client/recording/mavlink/mavlink_messages.hpp"
#include "telltale/client/recording/servo_outputs.hpp"
#include "telltale/client/recording/time_order.hpp"

namespace telltale {

/// Why a message of a live stream makes no sample.
enum class MavlinkReject {
  kClockUnknown,    ///< nothing yet says how the autopilot's clock stands to UTC
  kOtherClock,      ///< its time is not that of the autopilot's clock
  kNoFix,           ///< a position without a three-dimensional fix
  kRepeatedFix,     ///< a fix that is sent again
  kUnknownOutputs,  ///< nothing yet names the outputs of the thrusters
};

inline constexpr std::array kMavlinkRejects = {
    MavlinkReject::kClockUnknown, MavlinkReject::kOtherClock, MavlinkReject::kNoFix,
    MavlinkReject::kRepeatedFix, MavlinkReject::kUnknownOutputs};

std::string_view Name(MavlinkReject reason);

/// Turns what one autopilot says into telemetry, message by message.
///
/// Clock: samples bear UTC, in seconds since 1970. The first SYSTEM_TIME after a boot that knows
/// UTC says how UTC stands to the time since boot. Where none comes within three seconds, the
/// arrival of the least delayed message of these seconds does. What has been said holds until the
/// autopilot boots again, which its time since boot shows by going back by more than a second. A
/// time more than five seconds from the newest one is on another clock. Sources: as
/// MavlinkRecording has them; the second choice counts while the first has been silent for three
/// seconds.
class LiveMavlinkVehicle {
 public:
  using Publish = std::function<void(const RawSample&)>;

  /// Outputs of [1, 16] that drive the thrusters; those unset are named by PARAM_VALUE.
  LiveMavlinkVehicle(std::optional<int> port_channel, std::optional<int> starboard_channel,
                     ChannelChoice choice = {});

  /// A frame of the autopilot, and when it arrived, in UTC seconds by a clock that never goes back.
  void Take(const MavlinkFrame& frame, double arrival_s, const Publish& publish);

  std::optional<int> PortChannel() const;
  std::optional<int> StarboardChannel() const;
  std::uint64_t Boots() const { return boots_; }  ///< seen, the first included
  bool ClockFromSystemTime() const { return clock_from_system_time_; }
  std::uint64_t Published(Channel channel) const {
    return published_[static_cast<std::size_t>(channel)];
  }
  std::uint64_t Rejected(MavlinkReject reason) const {
    return rejected_[static_cast<std::size_t>(reason)];
  }

 private:
  struct Clock {
    double begun_s = 0.0;  ///< arrival of its first message
    double newest_s = 0.0;
    double least_offset_s = std::numeric_limits<double>::infinity();
    std::optional<double> utc_less_boot_s;
  };

  void Take(const MavlinkSystemTime& message, double arrival_s);
  void Take(const MavlinkGpsRawInt& message, double arrival_s, const Publish& publish);
  void Take(const MavlinkGlobalPositionInt& message, double arrival_s, const Publish& publish);
  void Take(const MavlinkAttitude& message, double arrival_s, const Publish& publish);
  void Take(const MavlinkServoOutputRaw& message, const Publish& publish);
  void Take(const MavlinkParamValue& message);

  void SeeBootTime(double boot_s, double arrival_s);
  std::optional<double> Utc(double boot_s);
  template <class Sample>
  void Deliver(Channel channel, Sample sample, const Publish& publish);
  void Reject(MavlinkReject reason) { ++rejected_[static_cast<std::size_t>(reason)]; }

  ChannelChoice choice_;
  std::optional<int> port_channel_;
  std::optional<int> starboard_channel_;
  AutopilotParameters parameters_;
  std::optional<Clock> clock_;
  std::uint64_t boots_ = 0;
  bool clock_from_system_time_ = false;
  std::optional<double> first_arrival_s_;
  double last_fix_arrival_s_ = 0.0;
  double last_attitude_arrival_s_ = 0.0;
  std::optional<std::uint64_t> last_fix_us_;
  std::array<std::uint64_t, kChannels.size()> published_{};
  std::array<std::uint64_t, kMavlinkRejects.size()> rejected_{};
};

}  // namespace telltale
