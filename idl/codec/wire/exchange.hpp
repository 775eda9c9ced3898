#pragma once

#include "telltale/idl/codec/codec_error.hpp"
#include "telltale/idl/codec/messages/exchange.hpp"
#include "telltale/idl/codec/wire/wire_sample.hpp"

namespace telltale {

/// Requests, progress and replies for the bus. Requires IsVehicleId() of vehicle and correlation
/// ids.
WireSample<telltale_wire_IdentifyRequest> Encode(const IdentifyRequest& request);
WireSample<telltale_wire_IdentifyProgress> Encode(const IdentifyProgress& progress);
WireSample<telltale_wire_IdentifyReply> Encode(const IdentifyReply& reply);
WireSample<telltale_wire_DiagnoseRequest> Encode(const DiagnoseRequest& request);
WireSample<telltale_wire_DiagnoseProgress> Encode(const DiagnoseProgress& progress);
WireSample<telltale_wire_DiagnoseReply> Encode(const DiagnoseReply& reply);

/// The way back. Refuses: identifiers that are none, names that are no enumerator, numbers outside
/// their range, a published reply without its result, and any other reply with one. An empty name
/// in a request leaves the choice to the daemon.
Decoded<IdentifyRequest> Decode(const telltale_wire_IdentifyRequest& wire);
Decoded<IdentifyProgress> Decode(const telltale_wire_IdentifyProgress& wire);
Decoded<IdentifyReply> Decode(const telltale_wire_IdentifyReply& wire);
Decoded<DiagnoseRequest> Decode(const telltale_wire_DiagnoseRequest& wire);
Decoded<DiagnoseProgress> Decode(const telltale_wire_DiagnoseProgress& wire);
Decoded<DiagnoseReply> Decode(const telltale_wire_DiagnoseReply& wire);

}  // namespace telltale
