#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "telltale/idl/codec/codec_error.hpp"

namespace telltale {

/// When a sample was measured. `field` empty: when its message was recorded.
struct MappedTime {
  std::string field;
  double unit_s = 1.0;    ///< of the field, seconds
  bool is_stamp = false;  ///< the field holds seconds and nanoseconds, as a time of ROS does
};

/// Positions in radians, degrees or parts of them, or in metres north and east of some origin, in
/// the place of latitude and longitude. `topic` is empty of a CSV file.
struct MappedPositions {
  std::string topic;
  MappedTime time;
  std::string latitude;
  std::string longitude;
  double unit_deg = 1.0;
  bool is_metres = false;
  bool held = false;  ///< a value equal to the one before is the same fix
};

struct MappedHeadings {
  std::string topic;
  MappedTime time;
  std::string field;
  double unit_deg = 1.0;
  bool is_quaternion = false;  ///< x, y, z and w below `field`
  bool is_east_north_up = false;
  double offset_deg = 0.0;
  bool held = false;
};

struct MappedThruster {
  std::string topic;
  MappedTime time;
  std::string field;
  bool is_pulse = true;  ///< microseconds; else a value of which these two are full thrust:
  double full_forward = 1.0;
  double full_reverse = -1.0;
};

/// Which topics or columns of a recording hold the three channels.
struct Mapping {
  std::string name;
  MappedPositions positions;
  MappedHeadings headings;
  MappedThruster port;
  MappedThruster starboard;
};

/// Mapping file (Protobuf text format) -> Mapping. `file` is only what errors call the text.
/// Refuses: unknown, missing and repeated fields, units and frames other than those of
/// proto/mapping.proto, newtons without the values of full thrust, full_forward and full_reverse of
/// one sign.
Decoded<Mapping> ParseMapping(std::string_view text, const std::string& file = "mapping file");

}  // namespace telltale
