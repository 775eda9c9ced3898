#pragma once

#include "telltale/idl/codec/codec_error.hpp"
#include "telltale/idl/codec/messages/model.hpp"
#include "telltale/idl/codec/wire/wire_sample.hpp"

namespace telltale {

/// A published model for the bus. Requires IsVehicleId(vehicle_id).
WireSample<telltale_wire_Model> Encode(const PublishedModel& model);

/// A published model from the bus. Refuses: strings that do not end within their bound, vehicle ids
/// that are none, names that are no enumerator, sequences of a wrong length, numbers outside their
/// range, and what ModelFault() refuses.
Decoded<PublishedModel> Decode(const telltale_wire_Model& wire);

}  // namespace telltale
