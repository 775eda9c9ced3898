#pragma once

#include "telltale/core/identification/identification.hpp"
#include "telltale/idl/codec/field_reader.hpp"
#include "telltale/idl/proto/model.pb.h"

namespace telltale {

proto::ManoeuvreAdvice ToProto(const ManoeuvreAdvice& advice);

/// The way back; `reader` reads that very message. Faults: an unset equation, numbers that are NaN,
/// a negative duration or half width.
ManoeuvreAdvice ReadManoeuvreAdvice(FieldReader reader, const proto::ManoeuvreAdvice& message);

}  // namespace telltale
