#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "telltale/client/recording/ros/cdr_reader.hpp"
#include "telltale/client/recording/source_log.hpp"

namespace telltale {

/// Gathers messages of ROS 2 topics; which topics count is chosen once all are read.
///
/// Position: the sensor_msgs/msg/NavSatFix topic with most fixes. Heading, in this order: a
/// std_msgs/msg/Float64 topic that ends in compass_hdg or heading (degrees clockwise from north),
/// sensor_msgs/msg/Imu, geometry_msgs/msg/QuaternionStamped, nav_msgs/msg/Odometry. Orientations
/// are east-north-up, REP 103, unless their frame_id names NED; heading = 90 deg - yaw. Outputs:
/// mavros_msgs/msg/RCOut, channels 1 and 3 (ArduPilot's skid steering) unless told otherwise; else
/// heron_msgs/msg/Drive; else one topic each
/// side, named left and right or port and starboard, of UInt16 (microseconds) or of
/// Float32 or Float64 shares in [-1, 1], which become 1500 + 400 share us. Clock: header stamps
/// where the sources have them and they agree with the times of recording to a second; else the
/// times of recording.
class RosRecording {
 public:
  /// A message of a topic, `type` as "sensor_msgs/msg/NavSatFix". Types of no use are passed over.
  void Take(std::string_view topic, std::string_view type, std::int64_t received_ns,
            std::span<const std::uint8_t> bytes,
            CdrReader::Encoding encoding = CdrReader::Encoding::kCdr);

  /// Requires: options.Validate() is empty.
  SourceLog Finish(const SourceOptions& options) const;

 private:
  enum class Kind { kUnknown, kPosition, kCompass, kOrientation, kOutputs, kDrive, kSide };
  struct Sample {
    double received_s = 0.0;
    std::optional<double> stamp_s;
    std::array<double, 2>
        values{};  ///< latitude, longitude | heading | port, starboard | share or pulse
    std::vector<std::uint16_t> outputs;
  };
  struct Topic {
    Kind kind = Kind::kUnknown;
    std::string type;
    int rank = 0;  ///< among sources of heading: the lower the better
    bool is_pulse = false;
    bool is_ned = false;
    std::uint64_t unreadable = 0;
    std::uint64_t without_fix = 0;
    std::vector<Sample> samples;
  };
  using Named = std::pair<const std::string, Topic>;

  const Named* Best(Kind kind) const;
  const Named* Side(bool is_port) const;
  /// Why the best topic was taken, where there are others.
  std::string Why(Kind kind, const char* reason) const;
  bool StampsAgree(const Named* named) const;

  std::map<std::string, Topic, std::less<>> topics_;
  std::uint64_t messages_ = 0;
};

}  // namespace telltale
