#pragma once

#include <vector>

#include "telltale/core/identification/identification.hpp"
#include "telltale/idl/codec/field_reader.hpp"
#include "telltale/idl/proto/model.pb.h"

namespace telltale {

/// The part of model.json that names what acts on the boat besides its coefficients. Requires:
/// effects of the library, a value for each of their parameters.
void WriteEffects(const std::vector<AddedEffect>& effects, proto::Model& message);

/// Fails on an effect that the library lacks or that is there twice, and on parameters that are not
/// its own by name, order, unit and range.
std::vector<AddedEffect> ReadEffects(FieldReader& reader, const proto::Model& message);

}  // namespace telltale
