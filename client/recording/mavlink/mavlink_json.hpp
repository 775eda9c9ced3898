#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string_view>

#include "telltale/client/recording/mavlink/mavlink_recording.hpp"

namespace telltale {

/// Whether a MavlinkRecording takes anything from messages of this name, "ATTITUDE".
bool IsMavlinkMessageOfUse(std::string_view type);

/// MAVLink messages as the BlueOS recorder writes them, JSON:
/// {"header": {"system_id": 1, ...}, "message": {"type": "ATTITUDE", "time_boot_ms": ..., ...}}.
class MavlinkJson {
 public:
  MavlinkJson();
  ~MavlinkJson();

  /// False: it is no such message, or lacks a field, or a field is not of its range. Messages of no
  /// use are passed over.
  bool Take(std::span<const std::uint8_t> json, MavlinkRecording& recording);

 private:
  struct Parser;
  std::unique_ptr<Parser> parser_;  ///< keeps its memory from message to message
};

}  // namespace telltale
