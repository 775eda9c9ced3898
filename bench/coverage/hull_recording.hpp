#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "coverage/clocks.hpp"
#include "coverage/hulls.hpp"
#include "telltale/core/data/samples.hpp"
#include "telltale/core/simulation/simulator.hpp"

namespace telltale::coverage {

/// What acts on the hull and how its sensors err.
struct Sea {
  Eigen::Vector3d gust_sigma{0.05, 0.05, 0.05};  ///< m/s^2, m/s^2, rad/s^2
  double gust_time_constant_s = 4.0;
  double wave_sigma = 0.0;  ///< m/s^2 in surge and sway, rad/s^2 in yaw, at the peak
  double wave_peak_hz = 0.35;
  double current_m_s = 0.1;        ///< one sigma north and east, of each recording
  double current_variation = 0.0;  ///< m/s, a Gauss-Markov process of 120 s on top
  double fix_noise_m = 0.02;
  double fix_drift_m = 0.1;  ///< a Gauss-Markov process of 20 s
  double heading_noise_deg = 0.5;
  double misalignment_deg = 2.0;  ///< one sigma, of each recording
};

/// Random steps of both propellers held for 1.5 to 6 s, recorded for `duration_s`: fixes at 5 Hz,
/// headings at 10 Hz. The hull is integrated at 0.01 s by Runge-Kutta.
Recording RecordHull(const Hull& hull, const Sea& sea, const Clocks& clocks, double duration_s,
                     double start_s, std::uint64_t seed);

/// A run of the hull as it is, under the same sea, from a state in mid-mission.
struct HullRun {
  Nu start;
  std::vector<TimedCommand> commands;  ///< from zero, held
  Eigen::Matrix3Xd nu;                 ///< after each step of `step_s`, through the water
};
HullRun RunHull(const Hull& hull, const Sea& sea, double duration_s, double step_s,
                std::uint64_t seed);

}  // namespace telltale::coverage
