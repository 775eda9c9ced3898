#pragma once

#include <cstdint>
#include <memory>
#include <set>
#include <span>
#include <string>
#include <string_view>

#include "telltale/client/recording/mapping/mapped_recording.hpp"
#include "telltale/client/recording/message_taker.hpp"
#include "telltale/client/recording/ros/message_definition.hpp"
#include "telltale/client/recording/ros/ros_channel.hpp"

namespace telltale {

/// Gathers what a mapping names from messages of ROS, by their definitions, and of JSON.
class MappedMessages {
 public:
  explicit MappedMessages(std::shared_ptr<const Mapping> mapping,
                          std::size_t most_bytes = kReadingBytes);

  /// Who takes the messages of a topic, for as long as this stays where it is; null where the
  /// mapping does not name it, or its type is not known.
  MessageTaker OpenRos(const RosChannel& channel, CdrReader::Encoding encoding);
  MessageTaker OpenJson(std::string_view topic);

  /// Gives the samples away.
  SourceLog Finish() &&;

 private:
  /// Whether the mapping names this topic; the report lists some of the others.
  bool Names(std::string_view topic);

  std::shared_ptr<const Mapping> mapping_;
  MappedRecording recording_;
  RosMessageTypes types_;
  std::set<std::string, std::less<>> other_topics_;  ///< that the mapping does not name
  std::uint64_t unreadable_ = 0;
};

}  // namespace telltale
