#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "telltale/client/recording/mapping/mapped_messages.hpp"
#include "telltale/client/recording/ros/ros_recording.hpp"

namespace telltale {

/// Where the messages of every ROS format go: to a mapping, where one is given, else to the rules
/// of RosRecording. Messages that rosbag2 compressed one by one, with zstd, are inflated, up to 64
/// MB each. Requires: options outlive it, and options.Validate() is empty.
class RosIntake {
 public:
  explicit RosIntake(const SourceOptions& options);

  void Take(std::string_view topic, std::string_view type, std::string_view definition,
            std::int64_t received_ns, std::span<const std::uint8_t> bytes,
            CdrReader::Encoding encoding = CdrReader::Encoding::kCdr);

  /// Null: no mapping is given.
  MappedMessages* Mapped() { return mapped_ ? &*mapped_ : nullptr; }

  SourceLog Finish() const { return mapped_ ? mapped_->Finish() : by_rules_.Finish(options_); }

 private:
  const SourceOptions& options_;
  std::optional<MappedMessages> mapped_;
  RosRecording by_rules_;
  std::vector<std::uint8_t> inflated_;
};

/// "sensor_msgs/NavSatFix" of ROS 1 as "sensor_msgs/msg/NavSatFix".
inline std::string TypeOfRos2(std::string_view type) {
  const std::size_t slash = type.find('/');
  if (slash == std::string_view::npos) return std::string(type);
  return std::string(type.substr(0, slash)) + "/msg" + std::string(type.substr(slash));
}

}  // namespace telltale
