#include "telltale/core/uncertainty/residual_disturbance.hpp"

#include <algorithm>
#include <functional>
#include <span>
#include <utility>

#include "telltale/core/base/parallel.hpp"
#include "telltale/core/estimation/regression/residual_autocovariance.hpp"
#include "telltale/core/estimation/weak_form/disturbance_estimate.hpp"

namespace telltale {
namespace {

// Large beside sensor noise, so that the residuals of drifting fixes hold little chance.
constexpr double kUnitDriftM = 0.03;

/// Autocovariances of the residuals that `theta` leaves, averaged over the replicates.
std::array<Eigen::VectorXd, 3> MeanAutocovariance(const FittedData& fitted,
                                                  const Eigen::VectorXd& theta,
                                                  std::span<const PreparedDataset> replicates) {
  std::array<Eigen::VectorXd, 3> autocovariance = SensorAutocovariances().noise;
  for (const PreparedDataset& replicate : replicates) {
    const WeakProblem problem = BuildWeakForm(replicate, fitted.regression, fitted.options.form);
    const auto residuals = ResidualsOf(fitted.fit, theta, replicate, problem);
    for (std::size_t j = 0; j < autocovariance.size(); ++j) {
      if (residuals[j].size() == 0) continue;
      const auto runs = RunsOf(problem.supports[j].first_rows, problem.phi.stride);
      autocovariance[j] += Autocovariance(runs, residuals[j], kDisturbanceLags) /
                           static_cast<double>(replicates.size());
    }
  }
  return autocovariance;
}

}  // namespace

std::optional<UndisturbedReplicates> SimulateUndisturbed(const FittedData& fitted,
                                                         const Eigen::VectorXd& theta,
                                                         const SyntheticSensors& sensors) {
  constexpr std::size_t kOfEachKind = UndisturbedReplicates::kOfEachKind;
  Disturbance drift;
  drift.gnss_drift_m = kUnitDriftM;
  UndisturbedReplicates undisturbed;
  std::array<bool, 2 * kOfEachKind> simulated{};
  ForEachIndex(simulated.size(), sensors.threads, [&](std::size_t i) {
    const bool drifts = i >= kOfEachKind;
    const std::size_t at = i % kOfEachKind;
    auto replicate = SimulateFit(fitted, theta, drifts ? drift : Disturbance(), sensors.noise_scale,
                                 sensors.seeds[at]);
    if (!replicate) return;
    (drifts ? undisturbed.with_drift : undisturbed.with_noise)[at] = *std::move(replicate);
    simulated[i] = true;
  });
  if (!std::all_of(simulated.begin(), simulated.end(), std::identity())) return std::nullopt;
  return undisturbed;
}

Disturbance DisturbanceFromResiduals(const FittedData& fitted, const Eigen::VectorXd& theta,
                                     const UndisturbedReplicates& undisturbed) {
  SensorAutocovariances sensors;
  sensors.noise = MeanAutocovariance(fitted, theta, undisturbed.with_noise);
  sensors.drift = MeanAutocovariance(fitted, theta, undisturbed.with_drift);
  for (std::size_t j = 0; j < sensors.drift.size(); ++j) {
    sensors.drift[j] -= sensors.noise[j];
    sensors.drift[j] /= kUnitDriftM * kUnitDriftM;
  }
  return EstimateDisturbance(fitted.dataset, fitted.fit, sensors);
}

}  // namespace telltale
