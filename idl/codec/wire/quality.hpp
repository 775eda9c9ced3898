#pragma once

#include "telltale/idl/codec/codec_error.hpp"
#include "telltale/idl/codec/messages/quality.hpp"
#include "telltale/idl/codec/wire/wire_sample.hpp"

namespace telltale {

/// The quality of a vehicle's telemetry and model for the bus. Requires IsVehicleId(vehicle_id)
/// or kUnattributed.
WireSample<telltale_wire_Quality> Encode(const Quality& quality);

/// The way back. Refuses: vehicle ids that are neither, equations that are none, numbers that are
/// NaN or outside their range.
Decoded<Quality> Decode(const telltale_wire_Quality& wire);

}  // namespace telltale
