#pragma once

#include "telltale/idl/codec/codec_error.hpp"
#include "telltale/idl/codec/messages/diagnosis.hpp"
#include "telltale/idl/codec/wire/wire_sample.hpp"

namespace telltale {

/// A published diagnosis for the bus. Requires IsVehicleId(vehicle_id).
WireSample<telltale_wire_Diagnosis> Encode(const PublishedDiagnosis& diagnosis);

/// A published diagnosis from the bus. Verdict and sentence of the wire struct repeat the report,
/// for readers without JSON, and are not read. Refuses what ParseReportJson() refuses, and a report
/// of another vehicle.
Decoded<PublishedDiagnosis> Decode(const telltale_wire_Diagnosis& wire);

}  // namespace telltale
