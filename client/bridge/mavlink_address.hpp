#pragma once

#include <cstdint>
#include <string>

#include <tl/expected.hpp>

namespace telltale {

/// Where a MAVLink stream comes from.
struct MavlinkAddress {
  enum class Kind { kUnknown, kUdp, kTcp, kSerial };
  Kind kind = Kind::kUnknown;
  std::string place;         ///< a host, or the path of a serial device
  std::uint32_t number = 0;  ///< port, [1, 65535]; or baud, [1200, 4000000]
};

/// `udp:HOST:PORT`, `tcp:HOST:PORT` or `serial:DEVICE:BAUD`; an IPv6 host stands in brackets. The
/// error names the part that is wrong and what is allowed.
tl::expected<MavlinkAddress, std::string> ParseMavlinkAddress(const std::string& text);

}  // namespace telltale
