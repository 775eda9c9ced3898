#pragma once

#include "telltale/core/identification/identification.hpp"
#include "telltale/idl/codec/field_reader.hpp"
#include "telltale/idl/proto/model.pb.h"

namespace telltale {

void Write(const Interval& interval, proto::Interval& message);
proto::Coefficient ToProto(const Coefficient& coefficient);

/// A coefficient with its bounds; `reader` reads that very message. Faults: an unset or unknown
/// status, an estimate that is not finite, a negative standard error, an interval that is missing,
/// has a level outside (0, 1], or has its lower bound above its upper bound.
Coefficient ReadCoefficient(FieldReader reader, const proto::Coefficient& message);

}  // namespace telltale
