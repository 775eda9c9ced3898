#pragma once

#include "telltale/core/identification/identification.hpp"
#include "telltale/core/validation/promotion.hpp"
#include "telltale/idl/codec/messages/model.hpp"

namespace telltale {

/// The promotion with the verdict WARN at least where less than half of the window is filled and
/// the model rests on less than a third of the rows behind a sound earlier one. That happens where
/// the window has lost its data: after a long silence, or where the state directory is new.
Promotion WarnIfThin(Promotion promotion, const Identification& identification, double window_fill,
                     const PublishedModel& sound);

}  // namespace telltale
