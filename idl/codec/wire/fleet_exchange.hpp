#pragma once

#include "telltale/idl/codec/codec_error.hpp"
#include "telltale/idl/codec/messages/fleet_exchange.hpp"
#include "telltale/idl/codec/wire/wire_sample.hpp"

namespace telltale {

/// Requires IsVehicleId() of correlation ids.
WireSample<telltale_wire_FleetRequest> Encode(const FleetRequest& request);
WireSample<telltale_wire_FleetProgress> Encode(const FleetProgress& progress);
WireSample<telltale_wire_FleetReply> Encode(const FleetReply& reply);

/// The way back. Refuses: identifiers that are none, names that are no enumerator, and numbers
/// outside their range. An empty verdict reads as unknown.
Decoded<FleetRequest> Decode(const telltale_wire_FleetRequest& wire);
Decoded<FleetProgress> Decode(const telltale_wire_FleetProgress& wire);
Decoded<FleetReply> Decode(const telltale_wire_FleetReply& wire);

}  // namespace telltale
