#pragma once

#include "telltale/core/estimation/regression/excitation_summary.hpp"
#include "telltale/core/vessel/model_structure.hpp"
#include "telltale/idl/codec/field_reader.hpp"
#include "telltale/idl/proto/model.pb.h"

namespace telltale {

/// How identifiable the coefficients of one equation are. Regressors go by name, since their places
/// depend on the parameterization.
proto::Excitation ToProto(const ExcitationSummary& summary, Parameterization parameterization);

/// The way back; `reader` reads that very message. Faults: an unset equation, regressors that the
/// equation lacks, numbers outside their range.
ExcitationSummary ReadExcitation(FieldReader reader, const proto::Excitation& message,
                                 Parameterization parameterization);

}  // namespace telltale
