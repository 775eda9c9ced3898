#include "telltale/core/uncertainty/sensor_residuals.hpp"

#include <algorithm>
#include <optional>
#include <span>

#include "telltale/core/base/parallel.hpp"
#include "telltale/core/estimation/regression/residual_autocovariance.hpp"

namespace telltale {
namespace {

// Large beside sensor noise, so that the residuals of drifting fixes hold little chance.
constexpr double kUnitDriftM = 0.03;

using Autocovariances = std::array<Eigen::VectorXd, 3>;  // by equation

/// Of the residuals that `theta` leaves in a replicate.
Autocovariances AutocovariancesIn(const PreparedDataset& replicate, const FittedData& fitted,
                                  const Eigen::VectorXd& theta) {
  Autocovariances autocovariances = SensorAutocovariances().noise;
  const WeakProblem problem = BuildWeakForm(replicate, fitted.regression, fitted.options.form);
  const auto residuals = ResidualsOf(fitted.fit, theta, replicate, problem);
  for (std::size_t j = 0; j < autocovariances.size(); ++j) {
    if (residuals[j].size() == 0) continue;
    const auto runs = RunsOf(problem.supports[j].first_rows, problem.phi.stride);
    autocovariances[j] = Autocovariance(runs, residuals[j], kDisturbanceLags);
  }
  return autocovariances;
}

Autocovariances Mean(std::span<const std::optional<Autocovariances>> replicates) {
  Autocovariances mean = SensorAutocovariances().noise;
  for (const auto& replicate : replicates) {
    for (std::size_t j = 0; j < mean.size(); ++j) {
      mean[j] += (*replicate)[j] / static_cast<double>(replicates.size());
    }
  }
  return mean;
}

}  // namespace

std::optional<SensorAutocovariances> SimulateSensorAutocovariances(
    const FittedData& fitted, const Eigen::VectorXd& theta, const ReplicateSensors& sensors) {
  constexpr std::size_t kOfEachKind = ReplicateSensors::kOfEachKind;
  Disturbance drift;
  drift.gnss_drift_m = kUnitDriftM;
  std::array<std::optional<Autocovariances>, 2 * kOfEachKind> simulated;
  ForEachIndex(simulated.size(), sensors.threads, [&](std::size_t i) {
    const bool drifts = i >= kOfEachKind;
    const auto replicate = SimulateFit(fitted, theta, drifts ? drift : Disturbance(),
                                       sensors.noise_scale, sensors.seeds[i % kOfEachKind]);
    if (replicate) simulated[i] = AutocovariancesIn(*replicate, fitted, theta);
  });
  const auto is_there = [](const auto& replicate) { return replicate.has_value(); };
  if (!std::ranges::all_of(simulated, is_there)) return std::nullopt;
  SensorAutocovariances of_sensors;
  of_sensors.noise = Mean(std::span(simulated).first(kOfEachKind));
  of_sensors.drift = Mean(std::span(simulated).last(kOfEachKind));
  for (std::size_t j = 0; j < of_sensors.drift.size(); ++j) {
    of_sensors.drift[j] -= of_sensors.noise[j];
    of_sensors.drift[j] /= kUnitDriftM * kUnitDriftM;
  }
  return of_sensors;
}

}  // namespace telltale
