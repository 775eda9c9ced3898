#pragma once

#include <cstdint>
#include <string>

namespace telltale {

/// How many ends of the other kind an end of this daemon is connected to.
struct TopicConnections {
  std::string topic;
  std::uint32_t matches = 0;
};

}  // namespace telltale
