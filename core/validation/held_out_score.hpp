#pragma once

#include "telltale/core/base/result.hpp"
#include "telltale/core/data/samples.hpp"
#include "telltale/core/identification/identify.hpp"
#include "telltale/core/validation/validation.hpp"
#include "telltale/core/vessel/vehicle.hpp"

namespace telltale {

/// Scores on data that took no part in fitting.
struct HeldOutScore {
  double training_s = 0.0;  ///< time span of the data behind the scored model
  double held_out_s = 0.0;  ///< time span of the data that it is scored on
  Metrics metrics;          ///< one free-run horizon
};

struct HeldOutOptions {
  double share = 0.2;              ///< of the fixes, the last ones, (0, 0.5]
  double horizon_s = 5.0;          ///< of the free runs, as in ValidationOptions
  std::size_t most_fixes = 10000;  ///< a longer recording is refused, since it costs too much
};

/// How long the part lasts that is held out, s.
double HeldOutSpan(const Recording& recording, const HeldOutOptions& held_out = {});

/// Identifies a model from the first part of a recording, without bounds, and scores it on the
/// rest. Refuses when: the recording has more than `most_fixes` fixes, either part cannot be
/// prepared or identified, an equation is missing, or no free run fits into the held-out part.
Result<HeldOutScore> ScoreOnHeldOutPart(const Recording& recording, const Vehicle& vehicle,
                                        const IdentifyOptions& options,
                                        const HeldOutOptions& held_out = {});

/// The same with the structure, the estimator and the sampling period of `identification`, which
/// these options made from this recording. The scored model has seen fewer data than
/// `identification`.
Result<HeldOutScore> ScoreOnHeldOutPart(const Recording& recording, const Vehicle& vehicle,
                                        const Identification& identification,
                                        const IdentifyOptions& options,
                                        const HeldOutOptions& held_out = {});

}  // namespace telltale
