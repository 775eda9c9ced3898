#pragma once

#include "telltale/core/identification/identification.hpp"
#include "telltale/idl/codec/field_reader.hpp"
#include "telltale/idl/proto/model.pb.h"

namespace telltale {

/// The numbers of a model with their bounds: coefficients and covariance, thruster time constant,
/// dead zone, disturbance, recording biases, joint bounds, added effects, simulation parameters.
void WriteEstimates(const Identification& identification, proto::Model& message);

/// Reads them into an identification whose structure is in place. Faults: what ReadCoefficient()
/// and ReadEffects() refuse; a covariance that is not square over the coefficients; a thruster time
/// constant without the dynamic structure, or that structure without one; its covariance with
/// another number of values than coefficients (none stands for zeros); a dead zone outside its
/// range; a disturbance without a number for each axis.
void ReadEstimates(FieldReader& reader, const proto::Model& message,
                   Identification& identification);

}  // namespace telltale
