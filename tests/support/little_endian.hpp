#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace telltale {

/// The bytes of an integer, the lowest first.
template <class Number>
std::string LittleEndian(Number value) {
  std::string bytes;
  for (std::size_t i = 0; i < sizeof(Number); ++i) {
    bytes.push_back(static_cast<char>(static_cast<std::uint64_t>(value) >> (8 * i) & 0xFF));
  }
  return bytes;
}

/// Its length in four bytes, then the text: as MCAP and ROS 1 have it.
inline std::string WithLength(const std::string& text) {
  return LittleEndian(static_cast<std::uint32_t>(text.size())) + text;
}

}  // namespace telltale
