#pragma once

#include <cstdint>
#include <string_view>

namespace telltale {

/// CRC-32 of the bytes.
std::uint32_t ChecksumOf(std::string_view bytes);

}  // namespace telltale
