#pragma once

#include <cstddef>
#include <vector>

#include "telltale/core/identification/identification.hpp"
#include "telltale/core/uncertainty/coverage.hpp"
#include "telltale/idl/codec/field_reader.hpp"
#include "telltale/idl/proto/model.pb.h"

namespace telltale {

/// The coverage check of a model with these coefficients. The message repeats which coefficient
/// each entry is of, and the intervals that follow from the counts.
proto::CoverageCheck ToProto(const CoverageCheck& coverage_check,
                             const std::vector<Coefficient>& coefficients);

/// The way back for a model of so many coefficients; `reader` reads that very message. Faults:
/// counts above their total, another number of entries than coefficients, shares outside [0, 1],
/// numbers that are not finite.
CoverageCheck ReadCoverageCheck(FieldReader reader, const proto::CoverageCheck& message,
                                std::size_t coefficients);

}  // namespace telltale
