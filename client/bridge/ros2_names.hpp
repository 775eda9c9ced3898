#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace telltale {

/// What stands for a vehicle in a pattern of namespaces and of vehicle ids.
inline constexpr const char* kVehiclePlaceholder = "{vehicle}";

/// "rt/boat1/fix" of DDS as "/boat1/fix"; nothing of what is no topic of ROS 2.
std::optional<std::string> RosTopicOfDds(std::string_view topic);

/// "sensor_msgs::msg::dds_::NavSatFix_" of DDS as "sensor_msgs/msg/NavSatFix"; nothing of what is
/// no message type of ROS 2.
std::optional<std::string> RosTypeOfDds(std::string_view type);

/// Whose a topic is: what stands at {vehicle} where the topic is below the namespace, empty where
/// the pattern has no {vehicle}; nothing of a topic that is not below it. {vehicle} stands for
/// characters other than '/'. "/{vehicle}" takes "/boat1/fix", "/" takes everything.
std::optional<std::string> VehicleInTopic(std::string_view pattern, std::string_view topic);

/// A pattern of vehicle ids with its {vehicle} replaced.
std::string VehicleIdOf(const std::string& pattern, const std::string& vehicle);

/// A vehicle id as a name that a topic of ROS 2 may contain: letters, digits and '_', no digit
/// first. "boat-1" becomes "boat_1", "007" becomes "vehicle_007".
std::string RosNameOf(std::string_view vehicle_id);

/// The first fault of a pattern of namespaces, with what is allowed.
std::optional<std::string> NamespaceFault(const std::string& pattern);

}  // namespace telltale
