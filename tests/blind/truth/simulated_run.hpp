#pragma once

#include <vector>

#include "mission.hpp"
#include "scenario.hpp"

namespace blind::truth {

inline constexpr double kStepS = 0.005;
inline constexpr int kStepsPerCommand = 4;  // an autopilot of 50 Hz

struct Pulses {
  double port_us = 1500.0;
  double starboard_us = 1500.0;
};

/// The boat every kStepS from time zero on, and what its thrusters were commanded.
struct Track {
  std::vector<State> states;
  std::vector<Pulses> commands;
};

/// What is simulated: `before` until the onset, then `after`, on the same day's sea.
struct SimulatedRun {
  Scenario before;
  Scenario after;
  double onset_s = 0.0;
  double duration_s = 600.0;
};

Track Simulate(const SimulatedRun& simulated_run, Mission mission, RandomStream rng);

}  // namespace blind::truth
