#pragma once

#include <optional>
#include <string_view>

namespace telltale {

/// One message or row of any format, seen by the names of its fields.
class MessageFields {
 public:
  MessageFields() = default;
  MessageFields(const MessageFields&) = delete;
  MessageFields& operator=(const MessageFields&) = delete;
  virtual ~MessageFields() = default;

  /// The number at a path such as "latitude", "pose.pose.orientation.x" or "channels[2]", counted
  /// from 0; none where the path leads nowhere or to something else.
  virtual std::optional<double> Number(std::string_view path) const = 0;
};

}  // namespace telltale
