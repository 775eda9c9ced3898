#pragma once

#include <vector>

#include "telltale/core/data/samples.hpp"
#include "telltale/core/effects/augmented_model.hpp"
#include "telltale/core/simulation/sensors.hpp"
#include "telltale/core/simulation/simulator.hpp"
#include "telltale/core/vessel/vehicle.hpp"

namespace telltale {

/// Simulate() of a model with effects, from rest and heading north; thrust states stay empty. The
/// boat starts in the middle of a current that shears.
/// Requires: commands in order of time, at least one; end_s after the first; step_s > 0.
std::vector<TimedState> Simulate(const AugmentedModel& model,
                                 const std::vector<TimedCommand>& commands, double end_s,
                                 double step_s, const HullParticulars& hull = {});

/// Measure() by sensors with the faults that the model names: antenna elsewhere, compass turned
/// or deviating, positions stamped late.
Recording Measure(const std::vector<TimedState>& track, const AugmentedModel& model,
                  const Vehicle& vehicle, const SensorOptions& options);

}  // namespace telltale
