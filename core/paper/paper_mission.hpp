#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "telltale/core/data/samples.hpp"
#include "telltale/core/simulation/sensors.hpp"
#include "telltale/core/simulation/simulator.hpp"

namespace telltale {

/// The paper's data set in numbers: 127 trajectory segments, 16,025 points at 5 Hz, 53.4 minutes.
inline constexpr std::size_t kPaperSegments = 127;
inline constexpr std::size_t kPaperPoints = 16025;

/// One trajectory segment: its commands and its number of points at 5 Hz.
struct PaperSegment {
  std::vector<TimedCommand> commands;  ///< from time zero
  std::size_t points = 0;
};

/// 127 segments as the paper describes them: forward runs at constant and at varying speed,
/// zigzags, circles to both sides, and turns in FR and RF, more of the latter than of FF; never RR.
std::vector<PaperSegment> PaperMission(std::uint64_t seed);

/// Simulates every segment from a slow start ahead and measures it with the given sensors; those of
/// SensorOptions are the paper's Table 1. The clock advances ten seconds between segments, so that
/// they stay apart.
Recording RecordPaperMission(const VesselModel& model, const SensorOptions& sensors,
                             std::uint64_t seed);

}  // namespace telltale
