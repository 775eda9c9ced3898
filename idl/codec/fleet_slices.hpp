#pragma once

#include <cstdint>
#include <string_view>

namespace telltale {

/// A fleet is divided into so many slices, which daemons share among themselves.
inline constexpr int kFleetSlices = 64;

/// The slice of a vehicle, [0, 63]: CRC-32 of its id, so the same in every program.
int SliceOf(std::string_view vehicle_id);

/// A set of slices: bit n stands for slice n.
using SliceSet = std::uint64_t;

inline constexpr SliceSet kAllSlices = ~SliceSet{0};

constexpr SliceSet SetOf(int slice) {
  return SliceSet{1} << slice;
}

}  // namespace telltale
