#pragma once

#include <cstdint>
#include <optional>

namespace telltale {

/// Counts the frames that one system and component of a link sent and that did not arrive, by
/// MAVLink's sequence number, which counts up by one modulo 256.
/// Assumes: fewer than 128 frames in a row are lost; a greater step is a frame that comes late or
/// twice. What a silence of more than two seconds hid is not counted, since the number may have
/// gone round or an autopilot begun anew.
class MavlinkSequenceGaps {
 public:
  /// How many frames are missing between the last frame and this one.
  std::uint64_t Take(std::uint8_t sequence, double arrival_s) {
    const bool continues = last_ && arrival_s - last_arrival_s_ <= kLongestSilenceS;
    const auto step = static_cast<std::uint8_t>(sequence - last_.value_or(0));
    last_arrival_s_ = arrival_s;
    if (continues && (step == 0 || step >= kHalfRound)) return 0;
    last_ = sequence;
    return continues ? step - 1u : 0;
  }

 private:
  static constexpr double kLongestSilenceS = 2.0;
  static constexpr std::uint8_t kHalfRound = 128;

  std::optional<std::uint8_t> last_;
  double last_arrival_s_ = 0.0;
};

}  // namespace telltale
