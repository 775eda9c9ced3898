#pragma once

#include "telltale/core/identification/identification.hpp"
#include "telltale/idl/codec/field_reader.hpp"
#include "telltale/idl/proto/model.pb.h"

namespace telltale {

/// What a model was made from and how: window, refusals and provenance. Counts beyond 32 bits
/// saturate.
proto::WindowSummary ToProto(const WindowSummary& window);
proto::Refusal ToProto(const Refusal& refusal);
proto::Provenance ToProto(const Provenance& provenance);

/// The way back; `reader` reads that very message. Faults: times that are not finite or the wrong
/// way round, unknown channels and reject reasons, a misspecification that is no ratio, and what
/// ReadModelChange() refuses.
WindowSummary ReadWindow(FieldReader reader, const proto::WindowSummary& message);
Refusal ReadRefusal(const FieldReader& reader, const proto::Refusal& message);
Provenance ReadProvenance(FieldReader reader, const proto::Provenance& message);

}  // namespace telltale
