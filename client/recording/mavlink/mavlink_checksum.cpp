#include "telltale/client/recording/mavlink/mavlink_checksum.hpp"

#include <array>
#include <cstddef>

namespace telltale {
namespace {

constexpr std::uint16_t kPolynomial = 0x8408;  // x^16 + x^12 + x^5 + 1, lowest bit first
constexpr std::uint16_t kStart = 0xFFFF;
constexpr std::size_t kAtOnce = 8;

using Table = std::array<std::uint16_t, 256>;

/// Table k holds what a byte adds to the checksum when k zero bytes follow it.
constexpr std::array<Table, kAtOnce> MakeTables() {
  std::array<Table, kAtOnce> tables{};
  for (std::size_t byte = 0; byte < 256; ++byte) {
    auto sum = static_cast<std::uint16_t>(byte);
    for (int bit = 0; bit < 8; ++bit) {
      sum = static_cast<std::uint16_t>((sum >> 1) ^ ((sum & 1) != 0 ? kPolynomial : 0));
    }
    tables[0][byte] = sum;
  }
  for (std::size_t k = 1; k < kAtOnce; ++k) {
    for (std::size_t byte = 0; byte < 256; ++byte) {
      const std::uint16_t sum = tables[k - 1][byte];
      tables[k][byte] = static_cast<std::uint16_t>((sum >> 8) ^ tables[0][sum & 0xFF]);
    }
  }
  return tables;
}

constexpr std::array<Table, kAtOnce> kTables = MakeTables();

std::uint16_t AddByte(std::uint16_t sum, std::uint8_t byte) {
  return static_cast<std::uint16_t>((sum >> 8) ^ kTables[0][(sum ^ byte) & 0xFF]);
}

/// The tables of eight bytes are looked up independently of each other, which a loop over single
/// bytes cannot do ("slicing by 8", Kounavis and Berry 2008).
std::uint16_t AddEight(std::uint16_t sum, const std::uint8_t* bytes) {
  std::uint16_t next = kTables[7][(bytes[0] ^ sum) & 0xFF] ^ kTables[6][bytes[1] ^ (sum >> 8)];
  for (std::size_t i = 2; i < kAtOnce; ++i) next ^= kTables[kAtOnce - 1 - i][bytes[i]];
  return next;
}

}  // namespace

std::uint16_t MavlinkChecksum(std::span<const std::uint8_t> summed, std::uint8_t extra) {
  std::uint16_t sum = kStart;
  std::size_t at = 0;
  for (; at + kAtOnce <= summed.size(); at += kAtOnce) sum = AddEight(sum, summed.data() + at);
  for (; at < summed.size(); ++at) sum = AddByte(sum, summed[at]);
  return AddByte(sum, extra);
}

}  // namespace telltale
