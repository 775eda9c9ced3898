#pragma once

#include <string>

#include "telltale/core/identification/model_change.hpp"
#include "telltale/idl/codec/field_reader.hpp"
#include "telltale/idl/proto/model.pb.h"

namespace telltale {

proto::ModelChange ToProto(const ModelChange& change);

/// The way back; `reader` reads that very message. Faults: an unset or unknown verdict or equation,
/// a p-value outside [0, 1], a standard error that is not positive, numbers that are not finite.
ModelChange ReadModelChange(FieldReader reader, const proto::ModelChange& message);

/// What `telltale compare` writes: the message alone.
std::string PrintChangeJson(const ModelChange& change);

}  // namespace telltale
