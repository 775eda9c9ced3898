#pragma once

#include <cstdint>

#include "coverage/independent_simulator.hpp"

namespace telltale::testing {

/// The boat of bench/coverage, whose simulator shares nothing with core's, in segments of 40 s;
/// `disturbed`: how much of the disturbances there.
inline Recording SimulateReferenceBoat(double disturbed, int segments, std::uint64_t seed,
                                       const coverage::Boat& boat = coverage::ReferenceBoat()) {
  coverage::SimulatedEnvironment environment;
  for (double& sigma : environment.disturbance_sigma) sigma *= disturbed;
  coverage::Mission mission;
  mission.segments = segments;
  return coverage::Simulate(boat, environment, mission, seed);
}

}  // namespace telltale::testing
