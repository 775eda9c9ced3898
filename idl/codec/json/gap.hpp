#pragma once

#include <optional>

#include "telltale/core/diagnosis/diagnosis.hpp"
#include "telltale/idl/codec/field_reader.hpp"
#include "telltale/idl/codec/json/coefficient.hpp"
#include "telltale/idl/proto/report.pb.h"

namespace telltale {

/// The gap at one horizon, and one cell of it. No region stands for all regions.
proto::Gap ToProto(const Gap& gap);
proto::GapCell ToProto(const GapCell& cell);
proto::GapCell::PropellerRegion RegionOf(const std::optional<PropellerRegion>& region);

/// The way back; `reader` reads that very message. Faults: an unset or unknown channel, region or
/// kind, a horizon that is not positive, negative errors, a p-value outside [0, 1], numbers that
/// are NaN.
Gap ReadGap(FieldReader reader, const proto::Gap& message);
GapCell ReadGapCell(FieldReader reader, const proto::GapCell& message);
std::optional<PropellerRegion> ReadRegion(FieldReader& reader,
                                          proto::GapCell::PropellerRegion value);

/// The closure of a gap, a channel or a cause: absent where there is no gap to close.
template <class Message>
void WriteClosure(const std::optional<ExcessExplained>& closure, Message& message) {
  if (!closure) return;
  message.set_closure(closure->share);
  Write(closure->interval, *message.mutable_closure_interval());
}

std::optional<ExcessExplained> ReadExcessExplained(FieldReader& reader);

}  // namespace telltale
