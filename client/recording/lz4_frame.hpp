#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace telltale {

/// Inflates one lz4 frame, which is to fill `out` exactly; false where it does not.
bool InflateLz4Frame(std::span<const std::uint8_t> compressed, std::vector<std::uint8_t>& out);

}  // namespace telltale
