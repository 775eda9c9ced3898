#pragma once

#include <string_view>

namespace telltale {

/// What a recording of ROS says of a topic.
struct RosChannel {
  std::string_view topic;
  std::string_view type;        ///< as package/msg/Type
  std::string_view definition;  ///< as in RosMessageType::Of; empty where there is none
};

}  // namespace telltale
