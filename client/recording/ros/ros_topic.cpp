#include "telltale/client/recording/ros/ros_topic.hpp"

#include <algorithm>
#include <cmath>
#include <initializer_list>

#include "telltale/client/recording/thruster_sides.hpp"
#include "telltale/core/base/degrees.hpp"

namespace telltale {
namespace {

constexpr int kDefaultPortChannel = 1;
constexpr int kDefaultStarboardChannel = 3;

struct RosHeader {
  double stamp_s = 0.0;
  std::string_view frame;
};

RosHeader ReadHeader(CdrReader& cdr) {
  if (cdr.IsRos1()) cdr.Read<std::uint32_t>();  // a sequence number
  const auto seconds = cdr.Read<std::int32_t>();
  const auto nanoseconds = cdr.Read<std::uint32_t>();
  return {seconds + 1e-9 * nanoseconds, cdr.ReadString()};
}

struct Quaternion {
  double x, y, z, w;
};

Quaternion ReadQuaternion(CdrReader& cdr) {
  Quaternion q{};
  q.x = cdr.Read<double>();
  q.y = cdr.Read<double>();
  q.z = cdr.Read<double>();
  q.w = cdr.Read<double>();
  return q;
}

double YawRad(const Quaternion& q) {
  return std::atan2(2.0 * (q.w * q.z + q.x * q.y), 1.0 - 2.0 * (q.y * q.y + q.z * q.z));
}

bool IsNull(const Quaternion& q) {
  return q.x == 0.0 && q.y == 0.0 && q.z == 0.0 && q.w == 0.0;
}

std::string Lower(std::string_view text) {
  std::string lower(text);
  for (char& c : lower) c = static_cast<char>(c >= 'A' && c <= 'Z' ? c + ('a' - 'A') : c);
  return lower;
}

bool Contains(std::string_view text, std::string_view part) {
  return text.find(part) != std::string_view::npos;
}

bool NamesNed(std::string_view frame) {
  return Contains(Lower(frame), "ned");
}

bool ContainsAny(std::string_view text, std::initializer_list<std::string_view> parts) {
  return std::ranges::any_of(parts, [&](std::string_view part) { return Contains(text, part); });
}

/// Whether a topic commands a thruster, by its last name: below /thrusters/left/ there may be its
/// angle (pos), its speed (ang_vel) and its temperature too.
bool CommandsThruster(std::string_view name) {
  const std::string_view last = name.substr(name.rfind('/') + 1);
  return ContainsAny(name, {"thrust", "propeller", "motor", "pwm"}) &&
         ContainsAny(last, {"thrust", "propeller", "motor", "pwm", "cmd", "command", "left",
                            "right", "port", "starboard"}) &&
         !ContainsAny(last, {"angle", "pos", "vel", "rpm", "temp", "current", "volt"});
}

/// -1 port, 1 starboard, 0 neither: of a topic for one thruster.
int SideOf(std::string_view topic) {
  const std::string name = Lower(topic);
  if (!CommandsThruster(name)) return 0;
  if (ContainsAny(name, {"left", "port"})) return -1;
  if (ContainsAny(name, {"right", "starboard"})) return 1;
  return 0;
}

bool IsCompassTopic(std::string_view topic) {
  const std::string name = Lower(topic);
  return name.ends_with("compass_hdg") || name.ends_with("heading");
}

std::optional<int> PlaceAmong(std::initializer_list<std::string_view> types,
                              std::string_view type) {
  const auto found = std::ranges::find(types, type);
  if (found == types.end()) return std::nullopt;
  return static_cast<int>(found - types.begin());
}

std::optional<int> OrientationRank(std::string_view type) {
  return PlaceAmong({"sensor_msgs/msg/Imu", "geographic_msgs/msg/GeoPoseStamped",
                     "geometry_msgs/msg/QuaternionStamped", "nav_msgs/msg/Odometry"},
                    type);
}

/// MAVROS has fixes of the receiver below raw/, and filtered ones beside them.
std::optional<int> PositionRankOf(std::string_view name, std::string_view type) {
  if (type == "sensor_msgs/msg/NavSatFix") return name.ends_with("raw/fix") ? 0 : 1;
  if (type == "geographic_msgs/msg/GeoPoseStamped") return 2;
  if (type == "nav_msgs/msg/Odometry") return 3;
  return std::nullopt;
}

/// Nothing of 0, 0, which is what stands there without a fix.
std::optional<GeographicPosition> ReadGeoPoint(CdrReader& cdr) {
  const auto latitude_deg = cdr.Read<double>();
  const auto longitude_deg = cdr.Read<double>();
  cdr.Read<double>();  // altitude
  if (latitude_deg == 0.0 && longitude_deg == 0.0) return std::nullopt;
  return GeographicPosition{latitude_deg, longitude_deg};
}

/// Nothing of what is not finite.
std::optional<GeographicPosition> ReadOdometryPoint(CdrReader& cdr, bool is_ned) {
  cdr.ReadString();  // the frame that is placed
  const auto x_m = cdr.Read<double>();
  const auto y_m = cdr.Read<double>();
  cdr.Read<double>();
  if (!std::isfinite(x_m) || !std::isfinite(y_m)) return std::nullopt;
  return PlaceOfOdometry(is_ned ? NorthEastPosition{x_m, y_m} : NorthEastPosition{y_m, x_m});
}

RosKind KindOf(std::string_view name, std::string_view type) {
  if (type == "sensor_msgs/msg/NavSatFix") return RosKind::kPosition;
  if (type == "mavros_msgs/msg/RCOut") return RosKind::kOutputs;
  if (type == "heron_msgs/msg/Drive") return RosKind::kDrive;
  if (type == "std_msgs/msg/Float64" && IsCompassTopic(name)) return RosKind::kCompass;
  if (OrientationRank(type)) return RosKind::kOrientation;
  const bool is_number = type == "std_msgs/msg/Float64" || type == "std_msgs/msg/Float32" ||
                         type == "std_msgs/msg/UInt16";
  return is_number && SideOf(name) != 0 ? RosKind::kSide : RosKind::kUnknown;
}

}  // namespace

RosTopic::RosTopic(std::string_view name, std::string_view type)
    : kind_(KindOf(name, type)),
      type_(type),
      rank_(OrientationRank(type).value_or(0)),
      position_rank_(PositionRankOf(name, type)) {
  is_port_ = kind_ == RosKind::kSide && SideOf(name) < 0;
  is_pulse_ = kind_ == RosKind::kSide && type == "std_msgs/msg/UInt16";
  is_single_ = type == "std_msgs/msg/Float32";
  is_imu_ = type == "sensor_msgs/msg/Imu";
}

const RosReading* RosTopic::Read(std::span<const std::uint8_t> bytes,
                                 CdrReader::Encoding encoding) {
  if (kind_ == RosKind::kUnknown) return nullptr;
  CdrReader cdr(bytes, encoding);
  RosReading& reading = reading_;
  reading.stamp_s.reset();
  reading.position.reset();
  bool is_usable = true;
  const auto stamp = [&](const RosHeader& header) {
    if (header.stamp_s != 0.0) reading.stamp_s = header.stamp_s;
    if (header.frame == frame_) return;
    frame_ = header.frame;
    is_ned_ = is_ned_ || NamesNed(frame_);
  };
  switch (kind_) {
    case RosKind::kPosition: {
      stamp(ReadHeader(cdr));
      const auto status = cdr.Read<std::int8_t>();
      cdr.Read<std::uint16_t>();
      const auto latitude_deg = cdr.Read<double>();
      reading.position = GeographicPosition{latitude_deg, cdr.Read<double>()};
      if (status < 0) {
        ++without_fix_;
        is_usable = false;
      }
      break;
    }
    case RosKind::kCompass: reading.values[0] = cdr.Read<double>(); break;
    case RosKind::kOrientation: {
      stamp(ReadHeader(cdr));
      if (position_rank_) {
        reading.position = IsOdometry() ? ReadOdometryPoint(cdr, is_ned_) : ReadGeoPoint(cdr);
      }
      const Quaternion q = ReadQuaternion(cdr);
      const double yaw_deg = YawRad(q) * kDegreesPerRadian;
      reading.values[0] = is_ned_ ? yaw_deg : 90.0 - yaw_deg;
      is_usable = !IsNull(q) && reading.position.has_value() == position_rank_.has_value();
      if (is_imu_ && cdr.Read<double>() == -1.0) is_usable = false;
      break;
    }
    case RosKind::kOutputs:
      stamp(ReadHeader(cdr));
      reading.output_count = cdr.ReadSequence(std::span<std::uint16_t>(reading.outputs));
      break;
    case RosKind::kDrive:
      reading.values[0] = static_cast<double>(cdr.Read<float>());
      reading.values[1] = static_cast<double>(cdr.Read<float>());
      break;
    case RosKind::kSide:
      reading.values[0] = is_pulse_    ? cdr.Read<std::uint16_t>()
                          : is_single_ ? static_cast<double>(cdr.Read<float>())
                                       : cdr.Read<double>();
      break;
    case RosKind::kUnknown: break;
  }
  if (!cdr.Ok()) ++unreadable_;
  return cdr.Ok() && is_usable ? &reading : nullptr;
}

RosOutputChannels::RosOutputChannels(const SourceOptions& options)
    : port(options.port_channel.value_or(kDefaultPortChannel)),
      starboard(options.starboard_channel.value_or(kDefaultStarboardChannel)) {}

std::optional<ThrusterSample> CommandsOf(RosKind kind, const RosReading& reading,
                                         const RosOutputChannels& channels, double time_s) {
  if (kind == RosKind::kDrive) {
    return ThrusterSample{time_s, PulseOfShare(reading.values[0]), PulseOfShare(reading.values[1])};
  }
  const auto most = static_cast<std::size_t>(std::max(channels.port, channels.starboard));
  if (reading.output_count < most) return std::nullopt;
  const auto pulse_us = [&](int channel) {
    return static_cast<double>(reading.outputs[static_cast<std::size_t>(channel - 1)]);
  };
  return ThrusterSample{time_s, pulse_us(channels.port), pulse_us(channels.starboard)};
}

}  // namespace telltale
