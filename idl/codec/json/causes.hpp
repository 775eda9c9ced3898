#pragma once

#include "telltale/core/diagnosis/diagnosis.hpp"
#include "telltale/idl/codec/field_reader.hpp"
#include "telltale/idl/proto/report.pb.h"

namespace telltale {

/// A cause with its effects. A cause without effects names "unknown", which no effect is called.
proto::Cause ToProto(const Cause& cause);

/// The way back; `reader` reads that very message. Faults: parameters and parts of an effect that
/// the cause does not name, a probability outside [0, 1], numbers that are NaN.
Cause ReadCause(FieldReader reader, const proto::Cause& message);

}  // namespace telltale
