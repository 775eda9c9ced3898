#pragma once

#include <vector>

#include "telltale/core/base/result.hpp"
#include "telltale/core/data/samples.hpp"
#include "telltale/core/identification/identification.hpp"
#include "telltale/core/vessel/vehicle.hpp"

namespace telltale {

/// Positions of the body origin, a second apart, all vectors of one length.
struct Path {
  std::vector<double> time_s;  ///< of the vehicle's clock
  std::vector<double> north_m;
  std::vector<double> east_m;
};

/// Where a boat went, and where its model says that the commands alone take it.
struct PredictedPaths {
  double horizon_s = 0.0;
  Path measured;                 ///< from its own first position on, without the gaps
  std::vector<Path> predicted;   ///< free runs one after the other, from the measured state each;
                                 ///< cut where the model diverges
  double position_rmse_m = 0.0;  ///< at the ends of the runs; infinite where one diverges
};

/// The paths over the last `span_s` of a recording that free runs of `horizon_s` cover.
/// Requires: span_s >= horizon_s.
/// Refuses when: the recording cannot be prepared, the model lacks an equation, or no run fits
/// between two gaps.
Result<PredictedPaths> PredictPaths(const Recording& recording, const Vehicle& vehicle,
                                    const Identification& identification, double span_s,
                                    double horizon_s);

}  // namespace telltale
