#pragma once

#include "telltale/client/workbench/note_sink.hpp"
#include "telltale/core/identification/identification.hpp"

namespace telltale {

/// Whether two models differ by more than their errors, with a note where they are of two boats or
/// seem to share data. Throws: RefusedError where ChangeBetween refuses.
ModelChange CompareModels(const Identification& earlier, const Identification& later,
                          const NoteSink& note);

}  // namespace telltale
