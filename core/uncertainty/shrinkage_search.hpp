#pragma once

#include <optional>
#include <utility>

#include "telltale/core/estimation/weak_form/weak_iv.hpp"
#include "telltale/core/uncertainty/fit_simulation.hpp"
#include "telltale/core/uncertainty/sensor_residuals.hpp"

namespace telltale {

/// Shrinkage levels of SimulablePosterior, [0, kShrinkageLevels).
inline constexpr int kShrinkageLevels = 7;

/// The distribution of plausible models at a shrinkage level, docs/concepts/model.md (34): the
/// higher the level, the more its mean is shrunk. The last level is the regularised fit alone,
/// without covariance.
RidgePosterior PosteriorAt(int shrinkage_level, const WeakFit& fit);

/// A distribution of plausible models whose mean can be simulated, with what the sensors alone
/// leave in its residuals.
struct SimulablePosterior {
  RidgePosterior posterior;
  SensorAutocovariances sensor_autocovariances;
};

/// The first result of `estimate`, a callable from a SimulablePosterior to an optional, over
/// shrinkage levels in ascending order. Levels whose mean diverges are skipped. Nothing when no
/// level gives a result.
template <class Estimate>
auto FirstSimulable(const FittedData& fitted, const ReplicateSensors& sensors,
                    const Estimate& estimate)
    -> decltype(estimate(std::declval<const SimulablePosterior&>())) {
  for (int level = 0; level < kShrinkageLevels; ++level) {
    SimulablePosterior simulable{PosteriorAt(level, fitted.fit), {}};
    auto of_sensors =
        SimulateSensorAutocovariances(fitted, simulable.posterior.posterior_mean, sensors);
    if (!of_sensors) continue;
    simulable.sensor_autocovariances = *std::move(of_sensors);
    if (auto estimated = estimate(simulable)) return estimated;
  }
  return std::nullopt;
}

}  // namespace telltale
