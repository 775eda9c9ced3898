#pragma once

#include <cstddef>
#include <string_view>

#include <tl/expected.hpp>

#include "telltale/core/vessel/vehicle.hpp"
#include "telltale/idl/codec/codec_error.hpp"
#include "telltale/idl/codec/wire/wire_sample.hpp"

namespace telltale {

/// Why an announcement names no boat.
enum class AnnouncementFaultReason {
  kMalformedId,
  kTooLarge,
  kNotText,         ///< it is not UTF-8, or has control characters other than tabs and line ends
  kNotVehicleFile,  ///< ParseVehicle() refuses it
  kOtherId,         ///< the file names another boat than the key
};

std::string_view Name(AnnouncementFaultReason reason);

struct AnnouncementFault {
  AnnouncementFaultReason reason = AnnouncementFaultReason::kMalformedId;
  CodecError error;

  std::string Message() const { return error.Message(); }
};

/// Of the vehicle file that an announcement carries.
inline constexpr std::size_t kLargestVehicleFile = 16384;

/// What a boat says of itself <-> wire. Encode requires IsVehicleId(vehicle.vehicle_id). Decode
/// refuses the first fault in the order of AnnouncementFaultReason.
WireSample<telltale_wire_VehicleAnnouncement> Encode(const Vehicle& vehicle);
tl::expected<Vehicle, AnnouncementFault> Decode(const telltale_wire_VehicleAnnouncement& wire);

/// The id in the key of an announcement, which is all that a notice of its end has.
Decoded<std::string> AnnouncedId(const telltale_wire_VehicleAnnouncement& wire);

/// The key alone, to say that the boat is retired. Requires IsVehicleId(vehicle_id).
WireSample<telltale_wire_VehicleAnnouncement> EncodeRetired(std::string_view vehicle_id);

}  // namespace telltale
