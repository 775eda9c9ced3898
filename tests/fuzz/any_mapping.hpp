#pragma once

#include <memory>

#include "telltale/idl/codec/mapping_file.hpp"

namespace telltale {

/// Names fields of the seeds and of arrays on every topic, so that definitions and paths are
/// walked.
inline std::shared_ptr<const Mapping> AnyMapping() {
  Mapping mapping;
  mapping.name = "any";
  mapping.positions.topic = "*";
  mapping.positions.latitude = "latitude";
  mapping.positions.longitude = "message.lon";
  mapping.headings.topic = "*";
  mapping.headings.field = "orientation";
  mapping.headings.is_quaternion = true;
  mapping.headings.time = {"header.stamp", 0.0, true};
  mapping.port.topic = "*";
  mapping.port.field = "channels[2]";
  mapping.starboard.topic = "*";
  mapping.starboard.field = "data";
  return std::make_shared<const Mapping>(mapping);
}

}  // namespace telltale
