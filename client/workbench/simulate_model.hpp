#pragma once

#include <optional>
#include <vector>

#include "telltale/core/effects/augmented_model.hpp"
#include "telltale/core/identification/identification.hpp"
#include "telltale/core/simulation/simulator.hpp"
#include "telltale/core/vessel/vehicle.hpp"

namespace telltale {

/// A boat driven open loop, and the model that drove it.
struct SimulatedModel {
  AugmentedModel model;
  std::vector<TimedState> track;
};

/// Drives a model from rest and heading north, from the first command to the last. `step_s`:
/// integrate the continuous equations with this step, seconds, [0.001, 1]; none: the discrete model
/// as it was identified. Throws: RefusedError where the model cannot be simulated, or diverges
/// under these commands. Requires: commands in order of time, at least one.
SimulatedModel SimulateModel(const Identification& identification,
                             const std::vector<TimedCommand>& commands, const Vehicle& vehicle,
                             const std::optional<double>& step_s);

}  // namespace telltale
