#pragma once

#include <cstdint>
#include <memory>
#include <set>
#include <span>
#include <string>
#include <string_view>

#include "telltale/client/recording/mapping/mapped_recording.hpp"
#include "telltale/client/recording/ros/message_definition.hpp"

namespace telltale {

/// Gathers what a mapping names from messages of ROS, by their definitions, and of JSON.
class MappedMessages {
 public:
  explicit MappedMessages(std::shared_ptr<const Mapping> mapping);

  /// `type` as package/msg/Type, `definition` as in RosMessageType::Of, empty where there is none.
  void TakeRos(std::string_view topic, std::string_view type, std::string_view definition,
               std::int64_t received_ns, std::span<const std::uint8_t> bytes,
               CdrReader::Encoding encoding);

  void TakeJson(std::string_view topic, std::int64_t received_ns,
                std::span<const std::uint8_t> bytes);

  /// Whether the mapping names this topic; the report lists some of the others.
  bool Names(std::string_view topic);

  /// Gives the samples away.
  SourceLog Finish() &&;

 private:
  std::shared_ptr<const Mapping> mapping_;
  MappedRecording recording_;
  RosMessageTypes types_;
  std::set<std::string, std::less<>> other_topics_;  ///< that the mapping does not name
  std::uint64_t unreadable_ = 0;
};

}  // namespace telltale
