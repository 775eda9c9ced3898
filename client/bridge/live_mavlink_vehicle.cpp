#include "telltale/client/bridge/live_mavlink_vehicle.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "telltale/client/bridge/patience.hpp"
#include "telltale/client/recording/mavlink/mavlink_recording.hpp"
#include "telltale/core/base/degrees.hpp"

namespace telltale {
namespace {

constexpr double kSetBackS = 1.0;
constexpr double kSameClockS = 5.0;
constexpr double kOutputRoundS = 4294.967296;  ///< 2^32 us

/// A time that begins anew every 71.6 minutes, in the round that is nearest to a full time.
double InRoundOf(double newest_s, double time_s) {
  return time_s + kOutputRoundS * std::round((newest_s - time_s) / kOutputRoundS);
}

}  // namespace

std::string_view Name(MavlinkReject reason) {
  switch (reason) {
    case MavlinkReject::kClockUnknown: return "before the clock was known";
    case MavlinkReject::kOtherClock: return "on another clock";
    case MavlinkReject::kNoFix: return "positions without a fix";
    case MavlinkReject::kRepeatedFix: return "positions sent again";
    case MavlinkReject::kUnknownOutputs: return "outputs of unknown thrusters";
  }
  return "unknown";
}

LiveMavlinkVehicle::LiveMavlinkVehicle(std::optional<int> port_channel,
                                       std::optional<int> starboard_channel, ChannelChoice choice)
    : choice_(std::move(choice)),
      port_channel_(port_channel),
      starboard_channel_(starboard_channel) {}

void LiveMavlinkVehicle::Take(const MavlinkFrame& frame, double arrival_s, const Publish& publish) {
  if (!first_arrival_s_) {
    first_arrival_s_ = last_fix_arrival_s_ = last_attitude_arrival_s_ = arrival_s;
  }
  switch (frame.message) {
    case MavlinkSystemTime::kId: return Take(SystemTimeOf(frame), arrival_s);
    case MavlinkGpsRawInt::kId: return Take(GpsRawIntOf(frame), arrival_s, publish);
    case MavlinkGlobalPositionInt::kId: return Take(GlobalPositionIntOf(frame), arrival_s, publish);
    case MavlinkAttitude::kId: return Take(AttitudeOf(frame), arrival_s, publish);
    case MavlinkServoOutputRaw::kId: return Take(ServoOutputRawOf(frame), publish);
    case MavlinkParamValue::kId: return Take(ParamValueOf(frame));
    default: return;
  }
}

std::optional<int> LiveMavlinkVehicle::PortChannel() const {
  return ThrusterChannel(port_channel_, parameters_, kThrottleLeft);
}

std::optional<int> LiveMavlinkVehicle::StarboardChannel() const {
  return ThrusterChannel(starboard_channel_, parameters_, kThrottleRight);
}

void LiveMavlinkVehicle::Take(const MavlinkSystemTime& message, double arrival_s) {
  const double boot_s = message.boot_ms * 1e-3;
  SeeBootTime(boot_s, arrival_s);
  if (message.unix_us == 0 || clock_->utc_less_boot_s) return;
  clock_->utc_less_boot_s = static_cast<double>(message.unix_us) * 1e-6 - boot_s;
  clock_from_system_time_ = true;
}

void LiveMavlinkVehicle::Take(const MavlinkGpsRawInt& message, double arrival_s,
                              const Publish& publish) {
  if (!message.HasFix()) return Reject(MavlinkReject::kNoFix);
  last_fix_arrival_s_ = arrival_s;
  if (last_fix_us_ == message.time_us) return Reject(MavlinkReject::kRepeatedFix);
  last_fix_us_ = message.time_us;
  double boot_s = static_cast<double>(message.time_us) * 1e-6;
  if (IsMavlinkUnixTime(boot_s) && clock_ && clock_->utc_less_boot_s) {
    boot_s -= *clock_->utc_less_boot_s;
  }
  Deliver(Channel::kGnss, GnssFix{boot_s, message.latitude_deg, message.longitude_deg}, publish);
}

void LiveMavlinkVehicle::Take(const MavlinkGlobalPositionInt& message, double arrival_s,
                              const Publish& publish) {
  const double boot_s = message.time_boot_ms * 1e-3;
  SeeBootTime(boot_s, arrival_s);
  if (arrival_s - last_fix_arrival_s_ > kSourcePatienceS) {
    Deliver(Channel::kGnss, GnssFix{boot_s, message.latitude_deg, message.longitude_deg}, publish);
  }
  if (message.heading_deg && arrival_s - last_attitude_arrival_s_ > kSourcePatienceS) {
    Deliver(Channel::kHeading, HeadingSample{boot_s, *message.heading_deg}, publish);
  }
}

void LiveMavlinkVehicle::Take(const MavlinkAttitude& message, double arrival_s,
                              const Publish& publish) {
  const double boot_s = message.time_boot_ms * 1e-3;
  SeeBootTime(boot_s, arrival_s);
  last_attitude_arrival_s_ = arrival_s;
  Deliver(Channel::kHeading,
          HeadingSample{boot_s, static_cast<double>(message.yaw_rad) * kDegreesPerRadian}, publish);
}

void LiveMavlinkVehicle::Take(const MavlinkServoOutputRaw& message, const Publish& publish) {
  if (message.bank != 0) return;
  const auto port = PortChannel();
  const auto starboard = StarboardChannel();
  if (!port || !starboard) return Reject(MavlinkReject::kUnknownOutputs);
  const double time_s = message.time_us * 1e-6;
  Deliver(Channel::kThrusters,
          ThrusterSample{clock_ ? InRoundOf(clock_->newest_s, time_s) : time_s,
                         PulseOn(message.pulse_us, *port), PulseOn(message.pulse_us, *starboard)},
          publish);
}

void LiveMavlinkVehicle::Take(const MavlinkParamValue& message) {
  if (!IsOutputParameter(message.name) || !std::isfinite(message.value)) return;
  parameters_[message.name] = static_cast<double>(message.value);
}

void LiveMavlinkVehicle::SeeBootTime(double boot_s, double arrival_s) {
  if (!clock_ || boot_s < clock_->newest_s - kSetBackS) {
    clock_ = Clock{};
    clock_->begun_s = arrival_s;
    clock_from_system_time_ = false;
    ++boots_;
  }
  clock_->newest_s = std::max(clock_->newest_s, boot_s);
  clock_->least_offset_s = std::min(clock_->least_offset_s, arrival_s - boot_s);
  if (!clock_->utc_less_boot_s && arrival_s - clock_->begun_s > kClockPatienceS) {
    clock_->utc_less_boot_s = clock_->least_offset_s;
  }
}

std::optional<double> LiveMavlinkVehicle::Utc(double boot_s) {
  if (!clock_ || !clock_->utc_less_boot_s) {
    Reject(MavlinkReject::kClockUnknown);
    return std::nullopt;
  }
  if (std::abs(boot_s - clock_->newest_s) > kSameClockS) {
    Reject(MavlinkReject::kOtherClock);
    return std::nullopt;
  }
  return boot_s + *clock_->utc_less_boot_s;
}

template <class Sample>
void LiveMavlinkVehicle::Deliver(Channel channel, Sample sample, const Publish& publish) {
  if (!Takes(choice_, channel)) return;
  const auto utc_s = Utc(sample.time_s);
  if (!utc_s) return;
  sample.time_s = *utc_s;
  ++published_[static_cast<std::size_t>(channel)];
  publish(sample);
}

}  // namespace telltale
