#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace telltale {

/// One MAVLink frame, version 1 or 2. Its payload may be shorter than the message: version 2 cuts
/// trailing zeros.
struct MavlinkFrame {
  std::uint8_t version = 0;    ///< 1 or 2
  std::uint8_t system = 0;     ///< which vehicle
  std::uint8_t component = 0;  ///< which part of it; an autopilot is 1
  std::uint32_t message = 0;   ///< message id
  std::span<const std::uint8_t> payload;
  std::uint8_t sequence = 0;  ///< of this system and component, counted up by one modulo 256
};

/// What the bytes hold beside frames, by kind.
struct MavlinkDamage {
  std::uint64_t corrupt_frames = 0;   ///< of a known message, with a wrong checksum
  std::uint64_t skipped_bytes = 0;    ///< between frames
  std::uint64_t truncated_bytes = 0;  ///< of a frame that the end cuts off
};

/// The frame that begins at `bytes`, and its length in bytes.
struct MavlinkParse {
  enum class Outcome { kUnknown, kFrame, kNotAFrame, kIncomplete };
  enum class Checksum { kUnknown, kRight, kWrong };  ///< unknown: of a message that is not known
  Outcome outcome = Outcome::kUnknown;
  MavlinkFrame frame;
  std::size_t length = 0;  ///< of the whole frame, checksum and signature included
  Checksum checksum = Checksum::kUnknown;
};

/// Reads one frame. The checksum of a message whose MavlinkCrcExtra() is known is compared; that of
/// any other message cannot be, because it depends on the message's definition. A signature is
/// passed over. Source: MAVLink developer guide, "Packet Serialization"; checksum X.25 with
/// CRC_EXTRA.
MavlinkParse ParseMavlinkFrame(std::span<const std::uint8_t> bytes);

/// The bytes of a frame, unsigned. Version 2 cuts the trailing zeros of the payload.
/// Requires: MavlinkCrcExtra(frame.message) is known; version 1 or 2; at most 255 bytes of payload.
std::vector<std::uint8_t> SerializeMavlinkFrame(const MavlinkFrame& frame);

/// Frames out of a byte stream that may begin, break and end anywhere: the stream of a serial line
/// or of datagrams. A frame of a known message counts where its checksum is right. A frame of any
/// other message counts where another frame, or the end, follows it. Wherever no frame counts, one
/// byte is skipped and the search goes on at the next, so that noise that begins as a frame does
/// hides no known message behind it.
class MavlinkStream {
 public:
  using Visit = std::function<void(const MavlinkFrame&)>;

  /// Visits each whole frame and returns how many bytes are done with; the rest is wanted again in
  /// front of what follows. With `at_end` nothing follows, and all bytes are done with.
  std::size_t Consume(std::span<const std::uint8_t> bytes, bool at_end, const Visit& visit);

  const MavlinkDamage& Damage() const { return damage_; }

 private:
  MavlinkDamage damage_;
};

/// The same of a telemetry log (tlog): each frame follows its time of arrival, eight bytes
/// big-endian, microseconds since 1970.
/// Source: MAVLink developer guide, "Telemetry log format".
class MavlinkTelemetryLog {
 public:
  using Visit = std::function<void(std::uint64_t arrival_us, const MavlinkFrame&)>;

  std::size_t Consume(std::span<const std::uint8_t> bytes, bool at_end, const Visit& visit);

  const MavlinkDamage& Damage() const { return damage_; }

 private:
  MavlinkDamage damage_;
};

/// Whether bytes begin like a telemetry log: a time between 2000 and 2100 and a frame.
bool BeginsLikeMavlinkTelemetryLog(std::span<const std::uint8_t> bytes);

/// Whether bytes begin with a frame of a known message and a right checksum, without a time.
bool BeginsLikeMavlinkStream(std::span<const std::uint8_t> bytes);

}  // namespace telltale
