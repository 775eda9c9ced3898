#pragma once

#include "telltale/core/diagnosis/diagnosis.hpp"
#include "telltale/idl/codec/field_reader.hpp"
#include "telltale/idl/proto/report.pb.h"

namespace telltale {

proto::MissingForce ToProto(const MissingForce& missing);

/// The way back; `reader` reads that very message. Faults: other than three components, a variable
/// that is none, negative shares above one, half widths and scatter, values that are no numbers.
MissingForce ReadMissingForce(FieldReader reader, const proto::MissingForce& message);

}  // namespace telltale
