#pragma once

#include <cstdint>
#include <vector>

#include "telltale/core/simulation/manoeuvres.hpp"

namespace telltale {

inline constexpr double kSampleMissionDurationS = 600.0;

/// Ten minutes that excite every coefficient of the simulated Yellowfish: FF, FR, RF and a little
/// RR, fast and slow steps, both sides alike. Its straight course is unstable at low speed and its
/// spins diverge near full command (docs/reference/yellowfish-twin.md); straights and circles are
/// therefore short and spins moderate.
std::vector<TimedCommand> SampleMission(std::uint64_t seed);

}  // namespace telltale
