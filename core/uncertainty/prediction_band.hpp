#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "telltale/core/simulation/simulator.hpp"
#include "telltale/core/vessel/disturbance.hpp"
#include "telltale/core/vessel/vessel_model.hpp"

namespace telltale {

/// Where a boat will be going, with how sure that is: velocities at equal steps.
/// Shapes: one column per step, rows u, v, r.
struct PredictionBand {
  double step_s = 0.0;
  Eigen::Matrix3Xd lower;
  Eigen::Matrix3Xd median;
  Eigen::Matrix3Xd upper;
};

/// Band of free runs over `models`, draws from a posterior, each with a disturbance of its own,
/// from one known state under commands held as in Simulate(): the central `level` of the runs, by
/// axis and step. Runs that blow up count as lying outside on either side in turn. Requires: at
/// least twenty models; commands as Simulate() requires them.
PredictionBand PredictBand(const std::vector<VesselModel>& models, const VesselState& start,
                           const std::vector<TimedCommand>& commands,
                           const Disturbance& disturbance, double horizon_s, double step_s,
                           double level, std::uint64_t seed);

}  // namespace telltale
