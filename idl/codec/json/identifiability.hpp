#pragma once

#include "telltale/core/identification/identification.hpp"
#include "telltale/idl/codec/field_reader.hpp"
#include "telltale/idl/proto/model.pb.h"

namespace telltale {

/// The parts of model.json that say how far the model can be trusted and what would tell more:
/// excitation, advice and the certificate.
void WriteIdentifiability(const Identification& identification, proto::Model& message);

/// Reads them into an identification whose equations, parameterization and coefficients are read
/// already; the first fault is the reader's.
void ReadIdentifiability(FieldReader& reader, const proto::Model& message,
                         Identification& identification);

}  // namespace telltale
