#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "telltale/client/recording/mapping/mapped_messages.hpp"
#include "telltale/client/recording/message_taker.hpp"
#include "telltale/client/recording/ros/ros_recording.hpp"
#include "telltale/client/recording/zstd_frame.hpp"

namespace telltale {

/// Where the messages of every ROS format go: to a mapping, where one is given, else to the rules
/// of RosRecording. Messages that rosbag2 compressed one by one, with zstd, are inflated, up to 64
/// MB each. Requires: options.Validate() is empty.
class RosIntake {
 public:
  explicit RosIntake(const SourceOptions& options);

  /// Who takes the messages of a topic, for as long as this stays where it is.
  MessageTaker Open(const RosChannel& channel,
                    CdrReader::Encoding encoding = CdrReader::Encoding::kCdr);

  /// Null: no mapping is given.
  MappedMessages* Mapped() { return mapped_ ? &*mapped_ : nullptr; }

  /// Remembers a topic that is of no use, to name it where a channel is missing. `what`: its type
  /// or encoding.
  void Leave(std::string_view topic, std::string_view what);

  /// Gives the samples away.
  SourceLog Finish() &&;

 private:
  std::span<const std::uint8_t> Inflated(std::span<const std::uint8_t> message);

  std::optional<MappedMessages> mapped_;
  RosRecording by_rules_;
  std::set<std::string> left_;  ///< topics of no use
  ZstdInflater zstd_;
  std::vector<std::uint8_t> inflated_;
};

/// "sensor_msgs/NavSatFix" of ROS 1 as "sensor_msgs/msg/NavSatFix".
inline std::string TypeOfRos2(std::string_view type) {
  const std::size_t slash = type.find('/');
  if (slash == std::string_view::npos) return std::string(type);
  return std::string(type.substr(0, slash)) + "/msg" + std::string(type.substr(slash));
}

}  // namespace telltale
