#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "telltale/client/recording/ros/cdr_reader.hpp"
#include "telltale/client/recording/ros/ros_topic.hpp"
#include "telltale/client/recording/source_log.hpp"

namespace telltale {

/// Gathers messages of ROS 2 topics; which topics count is chosen once all are read.
///
/// Position: the topic of positions of the best type (NavSatFix, GeoPoseStamped, Odometry), of
/// several the one with most fixes. Heading: a compass, else the topic of
/// orientations of the best type (Imu, GeoPoseStamped, QuaternionStamped, Odometry). Outputs:
/// RCOut, channels 1 and 3 unless told otherwise; else heron_msgs/msg/Drive; else one topic each
/// side. RosTopic says what these are. Clock: header stamps where the sources have them and they
/// agree with the times of recording to a second; else the times of recording.
class RosRecording {
 public:
  /// A message of a topic, `type` as "sensor_msgs/msg/NavSatFix". Types of no use are passed over.
  void Take(std::string_view topic, std::string_view type, std::int64_t received_ns,
            std::span<const std::uint8_t> bytes,
            CdrReader::Encoding encoding = CdrReader::Encoding::kCdr);

  /// Requires: options.Validate() is empty.
  SourceLog Finish(const SourceOptions& options) const;

 private:
  struct Sample {
    double received_s = 0.0;
    RosReading reading;
  };
  struct Topic {
    RosTopic source;
    std::vector<Sample> samples;
  };
  using Named = std::pair<const std::string, Topic>;

  /// A topic's rank for what is sought: the lower the better; nothing: it has none of it.
  using RankOf = std::function<std::optional<int>(const RosTopic&)>;
  static RankOf OfKind(RosKind kind);

  const Named* Best(const RankOf& rank_of) const;
  const Named* Side(bool is_port) const;
  /// Why the best topic was taken, where there are others.
  std::string Why(const RankOf& rank_of, const char* reason) const;
  bool StampsAgree(const Named* named) const;

  std::map<std::string, Topic, std::less<>> topics_;
  std::uint64_t messages_ = 0;
};

}  // namespace telltale
