#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "telltale/client/recording/odometry_origin.hpp"
#include "telltale/client/recording/ros/cdr_reader.hpp"
#include "telltale/client/recording/source_log.hpp"
#include "telltale/core/data/north_east_frame.hpp"

namespace telltale {

/// What the messages of a topic say of a vehicle.
enum class RosKind { kUnknown, kPosition, kCompass, kOrientation, kOutputs, kDrive, kSide };

/// The last output that a vehicle may drive a thruster by: SourceOptions::port_channel.
inline constexpr std::size_t kLastOutput = 16;

/// What one message says.
struct RosReading {
  std::optional<double> stamp_s;  ///< of its header, seconds since 1970
  std::optional<GeographicPosition> position;
  std::array<double, 2> values{};  ///< heading | port, starboard | share or pulse
  std::array<std::uint16_t, kLastOutput> outputs{};
  std::size_t output_count = 0;  ///< that the message has; those beyond kLastOutput are left out
};

/// A topic of ROS and what its messages say, by its name and type alone.
///
/// Positions: sensor_msgs/msg/NavSatFix; geographic_msgs/msg/GeoPoseStamped; nav_msgs/msg/Odometry,
/// whose metres count from an origin that it does not state, taken to be kOdometryOrigin. Compass:
/// std_msgs/msg/Float64 whose name ends in compass_hdg or heading, degrees clockwise from north.
/// Orientations: sensor_msgs/msg/Imu, geographic_msgs/msg/GeoPoseStamped,
/// geometry_msgs/msg/QuaternionStamped, nav_msgs/msg/Odometry, east-north-up, REP 103, unless their
/// frame_id names NED; heading = 90 deg - yaw. Outputs: mavros_msgs/msg/RCOut. Drive:
/// heron_msgs/msg/Drive. Sides: a topic for one thruster, named left and right or port and
/// starboard, of UInt16 (microseconds) or of Float32 or Float64 shares in [-1, 1]; not its angle or
/// speed.
class RosTopic {
 public:
  /// `type` as "sensor_msgs/msg/NavSatFix".
  RosTopic(std::string_view name, std::string_view type);

  /// What a message says, until the next one is read. Null where it is cut off, has no fix or no
  /// orientation.
  const RosReading* Read(std::span<const std::uint8_t> bytes,
                         CdrReader::Encoding encoding = CdrReader::Encoding::kCdr);

  RosKind Kind() const { return kind_; }
  const std::string& Type() const { return type_; }
  int Rank() const { return rank_; }  ///< among sources of heading: the lower the better
  /// Among sources of positions, likewise; nothing: it is none.
  std::optional<int> PositionRank() const { return position_rank_; }
  bool IsOdometry() const { return type_ == "nav_msgs/msg/Odometry"; }
  bool IsPort() const { return is_port_; }    ///< of kSide
  bool IsPulse() const { return is_pulse_; }  ///< of kSide: microseconds
  bool IsNed() const { return is_ned_; }      ///< of kOrientation, by what it has said so far
  std::uint64_t Unreadable() const { return unreadable_; }
  std::uint64_t WithoutFix() const { return without_fix_; }

 private:
  RosKind kind_ = RosKind::kUnknown;
  std::string type_;
  int rank_ = 0;
  std::optional<int> position_rank_;
  bool is_port_ = false;
  bool is_pulse_ = false;
  bool is_single_ = false;  ///< Float32
  bool is_imu_ = false;
  bool is_ned_ = false;
  std::string frame_;   ///< that the last header named
  RosReading reading_;  ///< of the last message: none is made, filled and copied for each
  std::uint64_t unreadable_ = 0;
  std::uint64_t without_fix_ = 0;
};

/// The channels of RCOut that count, from 1: those of `options`, else 1 and 3, which are
/// ArduPilot's skid steering.
struct RosOutputChannels {
  explicit RosOutputChannels(const SourceOptions& options);
  int port;
  int starboard;
};

/// The commands of a reading of kOutputs or kDrive; nothing where it has too few channels. Shares
/// of full thrust become PulseOfShare().
std::optional<ThrusterSample> CommandsOf(RosKind kind, const RosReading& reading,
                                         const RosOutputChannels& channels, double time_s);

}  // namespace telltale
