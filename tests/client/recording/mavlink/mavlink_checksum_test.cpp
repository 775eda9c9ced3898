#include "telltale/client/recording/mavlink/mavlink_checksum.hpp"

#include <cstdint>
#include <random>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>
#include <boost/crc.hpp>

namespace telltale {
namespace {

std::vector<std::uint8_t> BytesOf(std::string_view text) {
  return {text.begin(), text.end()};
}

// Source: the catalogue of parametrised CRC algorithms of Greg Cook, CRC-16/MCRF4XX: 6F91 is the
// checksum of "123456789".
TEST(MavlinkChecksum, IsThatOfTheCatalogue) {
  EXPECT_EQ(MavlinkChecksum(BytesOf("12345678"), '9'), 0x6F91);
}

TEST(MavlinkChecksum, AgreesWithBoostAtEveryLength) {
  std::mt19937 random(1);
  for (std::size_t length = 0; length <= 300; ++length) {
    std::vector<std::uint8_t> bytes(length);
    for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random());
    const auto extra = static_cast<std::uint8_t>(random());
    boost::crc_optimal<16, 0x1021, 0xFFFF, 0, true, true> expected;
    expected.process_bytes(bytes.data(), bytes.size());
    expected.process_byte(extra);
    ASSERT_EQ(MavlinkChecksum(bytes, extra), expected.checksum()) << length << " bytes";
  }
}

}  // namespace
}  // namespace telltale
