#pragma once

#include <string_view>

#include "telltale/idl/codec/codec_error.hpp"
#include "telltale/idl/codec/wire/messages.hpp"
#include "telltale/idl/codec/wire/wire_sample.hpp"

namespace telltale {

/// The sole gate between what moves on the bus and what the rest of the program works with.
///
/// Decode trusts nothing that came off the wire: strings must end within their bound, identifiers
/// (of vehicles and correlations) must satisfy IsVehicleId, enumerations are among their names,
/// sizes agree and numbers of a model are no NaN. Numbers of telemetry are left to the window,
/// which counts what it sets aside by reason. Encode requires what Decode demands of identifiers (a
/// broken contract otherwise, since every caller has checked them).

telltale_wire_GnssFix Encode(const Telemetry<GnssFix>& fix);
telltale_wire_Heading Encode(const Telemetry<HeadingSample>& heading);
telltale_wire_Thrusters Encode(const Telemetry<ThrusterSample>& thrusters);
WireSample<telltale_wire_Model> Encode(const PublishedModel& model);
WireSample<telltale_wire_IdentifyRequest> Encode(const IdentifyRequest& request);
WireSample<telltale_wire_IdentifyProgress> Encode(const IdentifyProgress& progress);
WireSample<telltale_wire_IdentifyReply> Encode(const IdentifyReply& reply);
WireSample<telltale_wire_Diagnosis> Encode(const PublishedDiagnosis& diagnosis);
WireSample<telltale_wire_DiagnoseRequest> Encode(const DiagnoseRequest& request);
WireSample<telltale_wire_DiagnoseProgress> Encode(const DiagnoseProgress& progress);
WireSample<telltale_wire_DiagnoseReply> Encode(const DiagnoseReply& reply);
WireSample<telltale_wire_Quality> Encode(const Quality& quality);

/// The vehicle id borrows from the wire struct.
Decoded<Telemetry<GnssFix>> Decode(const telltale_wire_GnssFix& wire);
Decoded<Telemetry<HeadingSample>> Decode(const telltale_wire_Heading& wire);
Decoded<Telemetry<ThrusterSample>> Decode(const telltale_wire_Thrusters& wire);
Decoded<PublishedModel> Decode(const telltale_wire_Model& wire);
Decoded<IdentifyRequest> Decode(const telltale_wire_IdentifyRequest& wire);
Decoded<IdentifyProgress> Decode(const telltale_wire_IdentifyProgress& wire);
Decoded<IdentifyReply> Decode(const telltale_wire_IdentifyReply& wire);
Decoded<PublishedDiagnosis> Decode(const telltale_wire_Diagnosis& wire);
Decoded<DiagnoseRequest> Decode(const telltale_wire_DiagnoseRequest& wire);
Decoded<DiagnoseProgress> Decode(const telltale_wire_DiagnoseProgress& wire);
Decoded<DiagnoseReply> Decode(const telltale_wire_DiagnoseReply& wire);
Decoded<Quality> Decode(const telltale_wire_Quality& wire);

}  // namespace telltale
