#pragma once

#include <string_view>
#include <vector>

#include "telltale/idl/codec/messages/quality.hpp"
#include "telltale/idl/codec/wire/wire_sample.hpp"
#include "telltale/idl/dds/ros2.h"

namespace telltale {

template <>
inline const dds_topic_descriptor_t& Descriptor<std_msgs_msg_dds__String_>() {
  return std_msgs_msg_dds__String__desc;
}
template <>
inline const dds_topic_descriptor_t& Descriptor<diagnostic_msgs_msg_dds__DiagnosticArray_>() {
  return diagnostic_msgs_msg_dds__DiagnosticArray__desc;
}

/// std_msgs/msg/String.
WireSample<std_msgs_msg_dds__String_> EncodeRosString(std::string_view text);

/// diagnostic_msgs/msg/DiagnosticArray: a status for each boat. Its level is the verdict (OK 0,
/// WARN 1, ERROR 2, STALE 3; an unknown verdict is STALE), its message the most serious reason, its
/// values the reasons by code, the telemetry and the model. Times are UTC seconds since 1970.
WireSample<diagnostic_msgs_msg_dds__DiagnosticArray_> EncodeRosDiagnostics(
    const std::vector<Quality>& boats, double time_unix_s);

}  // namespace telltale
