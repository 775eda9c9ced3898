#pragma once

#include <string>

#include "telltale/core/identification/identification.hpp"

namespace telltale {

/// What a model rests on, in sentences: its window, the drift of the fixes, the choice of the
/// estimator and the basis of the bounds.
std::string ModelNotes(const Identification& identification);

/// The bias of each recording with its bounds, as a table; empty where the model has none.
std::string RecordingBiasTable(const Identification& model);

/// "gnss 7 DUPLICATE, thrusters 2 NOT_FINITE", or "0 samples" without rejects, for
/// "... rejected".
std::string RejectedText(const RejectCounts& rejected);

}  // namespace telltale
