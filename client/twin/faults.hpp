#pragma once

#include <vector>

#include "telltale/core/data/samples.hpp"
#include "telltale/core/simulation/simulator.hpp"
#include "telltale/core/vessel/vessel_model.hpp"

namespace telltale {

/// What goes wrong with a simulated boat, by its own time.
struct TwinFaults {
  double port_strength = 1.0;  ///< the port propeller turns as if commanded this share, (0, 1]
  double weak_from_s = 0.0;    ///< since when
  double clock_jump_s = 0.0;   ///< how far its clock jumps ahead each time
  std::vector<double> clock_jumps_at_s;  ///< in order
};

/// The track of a boat whose port propeller weakens on the way; up to then it stays as it is.
/// Requires: a static continuous model, and a track that was simulated with it.
std::vector<TimedState> SimulateWeak(const VesselModel& boat, const TwinFaults& faults,
                                     std::vector<TimedState> track);

/// The recording as stamped by the boat's clock.
void JumpClock(const TwinFaults& faults, Recording& recording);

}  // namespace telltale
