#pragma once

#include <cstddef>
#include <vector>

#include "telltale/core/data/prepared_dataset.hpp"
#include "telltale/core/simulation/simulator.hpp"
#include "telltale/core/vessel/motion.hpp"
#include "telltale/core/vessel/propellers.hpp"
#include "telltale/core/vessel/vessel_model.hpp"

namespace telltale {

/// By row of a dataset, what the thrusters deliver at its start: of no account, and zero, in the
/// static structure.
using ThrustHistory = std::vector<ThrustRegressors>;

/// A segment is taken to begin in steady thrust; a wrong guess decays with the thruster's time
/// constant.
ThrustHistory FollowThrust(const PreparedDataset& dataset, const VesselModel& model);

/// The states of a model that starts from what row `first` measured and is fed commands alone, at
/// that row and the `steps` that follow it.
/// Requires: steps rows after the first in its segment.
std::vector<VesselState> RunFreely(const PreparedDataset& dataset, const VesselModel& model,
                                   const ThrustHistory& thrust, std::size_t first,
                                   std::size_t steps);

/// The first rows of all runs of `steps` inside segments, one after the other: each begins where
/// the one before it ends.
std::vector<std::size_t> FreeRunStarts(const PreparedDataset& dataset, std::size_t steps);

/// Free runs over a dataset, and those of them that left the limits of kFreeRunDivergence.
struct DivergenceCount {
  std::size_t runs = 0;
  std::size_t diverged = 0;
};

/// Runs of `horizon_s` from FreeRunStarts; of many, some sixty spread evenly.
DivergenceCount CountDivergences(const PreparedDataset& dataset, const VesselModel& model,
                                 double horizon_s);

/// Root mean square by which the same runs miss the measured velocities: each in units of the
/// fastest of its kind that was measured, and no miss by more than two of these.
double FreeRunError(const PreparedDataset& dataset, const VesselModel& model, double horizon_s);

}  // namespace telltale
