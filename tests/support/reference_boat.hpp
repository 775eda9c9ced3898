#pragma once

#include <cstdint>
#include <vector>

#include "coverage/truth.hpp"

namespace telltale::testing {

/// The boat of bench/coverage, whose simulator shares nothing with core's, in segments of 40 s;
/// `disturbed`: how much of the disturbances there.
inline Recording SailReferenceBoat(double disturbed, int segments, std::uint64_t seed,
                                   const coverage::Boat& boat = coverage::ReferenceBoat()) {
  coverage::Surroundings around;
  for (double& sigma : around.disturbance_sigma) sigma *= disturbed;
  coverage::Mission mission;
  mission.segments = segments;
  return coverage::Sail(boat, around, mission, seed);
}

/// Its coefficients in the order in which an identification lists them.
inline std::vector<double> CoefficientsOf(const coverage::Boat& boat) {
  std::vector<double> all(boat.surge.begin(), boat.surge.end());
  all.insert(all.end(), boat.sway.begin(), boat.sway.end());
  all.insert(all.end(), boat.yaw.begin(), boat.yaw.end());
  return all;
}

}  // namespace telltale::testing
