#pragma once

#include <cstdint>

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

}  // namespace telltale::testing
