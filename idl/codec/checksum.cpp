#include "telltale/idl/codec/checksum.hpp"

#include <boost/crc.hpp>

namespace telltale {

std::uint32_t ChecksumOf(std::string_view bytes) {
  boost::crc_32_type crc;
  crc.process_bytes(bytes.data(), bytes.size());
  return crc.checksum();
}

}  // namespace telltale
