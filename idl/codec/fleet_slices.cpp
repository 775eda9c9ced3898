#include "telltale/idl/codec/fleet_slices.hpp"

#include "telltale/idl/codec/checksum.hpp"

namespace telltale {

int SliceOf(std::string_view vehicle_id) {
  return static_cast<int>(ChecksumOf(vehicle_id) % kFleetSlices);
}

}  // namespace telltale
