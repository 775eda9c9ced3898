#pragma once

#include <cstddef>
#include <vector>

#include "telltale/core/data/prepared_dataset.hpp"
#include "telltale/core/simulation/simulator.hpp"
#include "telltale/core/vessel/motion.hpp"
#include "telltale/core/vessel/propellers.hpp"
#include "telltale/core/vessel/vessel_model.hpp"

namespace telltale {

/// By row of a dataset, the propeller regressors at its start. Zero and unused in the static
/// structure.
using ThrustHistory = std::vector<ThrustRegressors>;

/// The thrust along each segment of a dataset. Assumes: a segment begins in steady thrust; an error
/// in that decays with the thruster's time constant.
ThrustHistory FollowThrust(const PreparedDataset& dataset, const VesselModel& model);

/// The states of a model that starts from the measured state of row `first` and follows the
/// commands alone: at that row and the `steps` rows after it. Requires: `steps` rows after the
/// first in its segment.
std::vector<VesselState> RunFreely(const PreparedDataset& dataset, const VesselModel& model,
                                   const ThrustHistory& thrust, std::size_t first,
                                   std::size_t steps);

/// The first rows of all runs of `steps` rows inside a segment, or inside the segments of a
/// dataset; each run begins where the one before it ends.
std::vector<std::size_t> FreeRunStarts(const RowRange& segment, std::size_t steps);
std::vector<std::size_t> FreeRunStarts(const PreparedDataset& dataset, std::size_t steps);

/// Free runs over a dataset, and those of them that left the limits of kFreeRunDivergence.
struct DivergenceCount {
  std::size_t runs = 0;
  std::size_t diverged = 0;
};

/// Runs of `horizon_s` from FreeRunStarts. Of many runs some sixty are taken, spread evenly.
DivergenceCount CountDivergences(const PreparedDataset& dataset, const VesselModel& model,
                                 double horizon_s);

/// The root mean square error of the velocities of the same runs, each in units of the fastest of
/// its kind that was measured. An error counts two of these units at most; so does NaN.
double FreeRunError(const PreparedDataset& dataset, const VesselModel& model, double horizon_s);

}  // namespace telltale
