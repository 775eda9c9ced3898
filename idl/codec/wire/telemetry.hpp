#pragma once

#include "telltale/core/data/samples.hpp"
#include "telltale/idl/codec/codec_error.hpp"
#include "telltale/idl/codec/messages/telemetry.hpp"
#include "telltale/idl/dds/telltale.h"

namespace telltale {

/// Telemetry samples between the bus and the program.
/// Encode requires IsVehicleId(vehicle_id).
/// Decode refuses a vehicle id that is not one. It does not check the numbers: the window rejects
/// and counts them by reason. The decoded vehicle id borrows from the wire struct.
telltale_wire_GnssFix Encode(const Telemetry<GnssFix>& fix);
telltale_wire_Heading Encode(const Telemetry<HeadingSample>& heading);
telltale_wire_Thrusters Encode(const Telemetry<ThrusterSample>& thrusters);

Decoded<Telemetry<GnssFix>> Decode(const telltale_wire_GnssFix& wire);
Decoded<Telemetry<HeadingSample>> Decode(const telltale_wire_Heading& wire);
Decoded<Telemetry<ThrusterSample>> Decode(const telltale_wire_Thrusters& wire);

}  // namespace telltale
