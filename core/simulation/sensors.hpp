#pragma once

#include <cstdint>
#include <vector>

#include "telltale/core/data/prepared_dataset.hpp"
#include "telltale/core/data/samples.hpp"
#include "telltale/core/simulation/simulator.hpp"
#include "telltale/core/vessel/vehicle.hpp"

namespace telltale {

/// The sensors of the paper's Table 1: GNSS at 5 Hz, PWM at 10 Hz, heading at 50 Hz, white noise.
struct SensorOptions {
  double gnss_period_s = 0.2;
  double heading_period_s = 0.02;
  double thruster_period_s = 0.1;
  double position_noise_m = 0.01;  ///< one sigma per axis
  double heading_noise_deg = 0.2;  ///< one sigma
  FrameOrigin origin{37.4205, -5.9944};
  std::uint64_t seed = 1;
};

/// What a boat's sensors report along a simulated track: antenna positions as latitude and
/// longitude, headings in [0, 360), commands as pulse widths rounded to a microsecond.
Recording Measure(const std::vector<TimedState>& track, const Vehicle& vehicle,
                  const SensorOptions& options);

}  // namespace telltale
