#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "insist.hpp"
#include "telltale/client/recording/ros/ros_recording.hpp"

namespace {

using telltale::Insist;

constexpr std::array kTopics = {std::pair("/gps/fix", "sensor_msgs/msg/NavSatFix"),
                                std::pair("/imu/data", "sensor_msgs/msg/Imu"),
                                std::pair("/odom", "nav_msgs/msg/Odometry"),
                                std::pair("/ap/geopose", "geographic_msgs/msg/GeoPoseStamped"),
                                std::pair("/attitude", "geometry_msgs/msg/QuaternionStamped"),
                                std::pair("/compass_hdg", "std_msgs/msg/Float64"),
                                std::pair("/rc/out", "mavros_msgs/msg/RCOut"),
                                std::pair("/thrusters/left/thrust", "std_msgs/msg/Float64"),
                                std::pair("/thrusters/right/thrust", "std_msgs/msg/Float32"),
                                std::pair("/pwm/port", "std_msgs/msg/UInt16"),
                                std::pair("/chatter", "std_msgs/msg/String")};

}  // namespace

/// Messages out of the bytes, each after its topic and its length; no sample comes from nothing,
/// and a message makes a position and a heading at most.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  telltale::SourceOptions options;
  if (size % 2 == 0) options.port_channel = 16;
  telltale::RosRecording recording(options);
  std::size_t messages = 0;
  for (std::size_t at = 0; at + 2 <= size; ++messages) {
    const auto [topic, type] = kTopics[data[at] % kTopics.size()];
    const std::size_t length = std::min<std::size_t>(data[at + 1], size - at - 2);
    if (const auto take = recording.Open({topic, type, {}})) {
      take(static_cast<std::int64_t>(at) * 1'000'000, {data + at + 2, length});
    }
    at += 2 + length;
  }
  const telltale::SourceLog log = std::move(recording).Finish();
  Insist(log.gnss.size() + log.heading.size() + log.thrusters.size() <= 2 * messages);
  Insist(!log.summary.empty());
  return 0;
}
