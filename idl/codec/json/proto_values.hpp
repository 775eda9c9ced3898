#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>

namespace telltale {

/// Between an enumeration of core and its Protobuf likeness, either way: both have the same order,
/// unknown first; tests hold them to it.
template <class To, class From>
To EnumCast(From value) {
  return static_cast<To>(static_cast<int>(value));
}

/// A count as messages hold it; the most they can hold where it is more.
inline std::uint32_t Saturated(std::uint64_t count) {
  constexpr std::uint64_t kMost = std::numeric_limits<std::uint32_t>::max();
  return static_cast<std::uint32_t>(std::min(count, kMost));
}

}  // namespace telltale
