#pragma once

#include <vector>

#include "data/samples.hpp"
#include "effects/augmented_model.hpp"
#include "simulation/sensors.hpp"
#include "simulation/simulator.hpp"
#include "vessel/vehicle.hpp"

namespace telltale {

/// Simulate() of a model with effects, from rest and heading north; thrust states stay empty.
/// Requires: commands in order of time, at least one; end_s after the first; step_s > 0.
std::vector<TimedState> Simulate(const AugmentedModel& model,
                                 const std::vector<TimedCommand>& commands, double end_s,
                                 double step_s);

/// Measure() by sensors with the faults that the model names: antenna elsewhere, compass turned,
/// positions stamped late.
Recording Measure(const std::vector<TimedState>& track, const AugmentedModel& model,
                  const Vehicle& vehicle, const SensorOptions& options);

}  // namespace telltale
