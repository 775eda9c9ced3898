#pragma once

#include <cstdint>
#include <string_view>

namespace telltale {

/// One telemetry sample on its way from a vehicle to the daemon. The sequence number counts up by
/// one per sample of a channel, so that a receiver sees loss. vehicle_id borrows its characters
/// from the wire struct or from the caller.
template <class Sample>
struct Telemetry {
  std::string_view vehicle_id;
  std::uint64_t sequence_number = 0;
  Sample sample;
};

}  // namespace telltale
