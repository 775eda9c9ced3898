#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <dds/dds.h>

#include <dds/ddsi/ddsi_serdata.h>

#include "telltale/client/bus/participant.hpp"

namespace telltale {

/// A sample as it travels: four bytes of encapsulation, then its fields.
struct SerializedSample : ddsi_serdata {
  std::vector<std::uint8_t> bytes;
};

/// A topic of a type that is known by its name alone: its samples stay as they came. Without a key,
/// without type information, so that it matches by topic and type name, as topics of ROS 2 do.
/// Throws BusError.
Entity SerializedTopic(const Participant& participant, const std::string& topic,
                       const std::string& type);

}  // namespace telltale
