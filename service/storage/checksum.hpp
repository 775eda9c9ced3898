#pragma once

#include <cstdint>
#include <string_view>

#include <boost/crc.hpp>

namespace telltale {

/// CRC-32 of the bytes.
inline std::uint32_t ChecksumOf(std::string_view bytes) {
  boost::crc_32_type crc;
  crc.process_bytes(bytes.data(), bytes.size());
  return crc.checksum();
}

}  // namespace telltale
