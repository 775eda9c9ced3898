#include "telltale/client/workbench/simulate_model.hpp"

#include <cmath>
#include <utility>

#include "telltale/client/report/number_text.hpp"
#include "telltale/client/workbench/errors.hpp"
#include "telltale/core/diagnosis/hypotheses/augmented_identification.hpp"
#include "telltale/core/effects/augmented_simulation.hpp"
#include "telltale/core/simulation/divergence.hpp"

namespace telltale {
namespace {

// The discrete model as identified, or its equations integrated at the step that was asked for.
VesselModel Discretised(VesselModel model, const std::optional<double>& step_s) {
  if (step_s) model.discretisation = Discretisation::kContinuous;
  return model;
}

bool IsFinite(const Eta& eta) {
  return std::isfinite(eta.x_m) && std::isfinite(eta.y_m) && std::isfinite(eta.psi_rad);
}

void RefuseDivergence(const std::vector<TimedState>& track) {
  for (const TimedState& instant : track) {
    const bool diverged = kOpenLoopDivergence.Exceeds(instant.state.nu);
    if (!diverged && IsFinite(instant.state.eta)) continue;
    throw RefusedError({"simulation",
                        "the velocity grows without bound from " + Fixed(instant.time_s, 1) +
                            " s on: this model is not stable under these commands",
                        "stay within the commands that made the model, or try a smaller --step"});
  }
}

}  // namespace

SimulatedModel SimulateModel(const Identification& identification,
                             const std::vector<TimedCommand>& commands, const Vehicle& vehicle,
                             const std::optional<double>& step_s) {
  AugmentedModel model = OrThrow(AugmentedModelOf(identification));
  model.model = Discretised(std::move(model.model), step_s);
  const double period_s = step_s.value_or(model.model.sampling_period_s);
  const double end_s = commands.back().time_s;
  auto track = model.effects.empty()
                   ? Simulate(model.model, {}, commands, end_s, period_s)
                   : Simulate(model, commands, end_s, period_s, vehicle.HullOrDefault());
  RefuseDivergence(track);
  return {std::move(model), std::move(track)};
}

}  // namespace telltale
