#pragma once

#include <cstdint>
#include <span>

namespace telltale {

/// The checksum of a MAVLink frame: X.25, also called CRC-16/MCRF4XX, over `summed` (header without
/// its first byte, and payload) and then over `extra`, the message's CRC_EXTRA.
/// Source: MAVLink developer guide, "Packet Serialization".
std::uint16_t MavlinkChecksum(std::span<const std::uint8_t> summed, std::uint8_t extra);

}  // namespace telltale
