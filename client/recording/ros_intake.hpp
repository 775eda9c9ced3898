#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "telltale/client/recording/mapping/mapped_messages.hpp"
#include "telltale/client/recording/ros/ros_recording.hpp"
#include "telltale/client/recording/zstd_frame.hpp"

namespace telltale {

/// Where the messages of every ROS format go: to a mapping, where one is given, else to the rules
/// of RosRecording. Messages that rosbag2 compressed one by one, with zstd, are inflated, up to 64
/// MB each. Requires: options.Validate() is empty.
class RosIntake {
 public:
  explicit RosIntake(const SourceOptions& options);

  void Take(std::string_view topic, std::string_view type, std::string_view definition,
            std::int64_t received_ns, std::span<const std::uint8_t> bytes,
            CdrReader::Encoding encoding = CdrReader::Encoding::kCdr);

  /// Null: no mapping is given.
  MappedMessages* Mapped() { return mapped_ ? &*mapped_ : nullptr; }

  /// Whether messages of such a topic are of use.
  bool Wants(std::string_view topic, std::string_view type) {
    return mapped_ ? mapped_->Names(topic) : RosRecording::Wants(topic, type);
  }

  /// Gives the samples away.
  SourceLog Finish() && {
    return mapped_ ? std::move(*mapped_).Finish() : std::move(by_rules_).Finish();
  }

 private:
  std::optional<MappedMessages> mapped_;
  RosRecording by_rules_;
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
