#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include <Eigen/Core>

#include "telltale/core/data/prepared_dataset.hpp"
#include "telltale/core/uncertainty/fit_simulation.hpp"
#include "telltale/core/vessel/disturbance.hpp"

namespace telltale {

/// Synthetic datasets free of disturbance: what the sensors alone make of the simulated motion.
struct UndisturbedReplicates {
  static constexpr std::size_t kOfEachKind = 2;

  std::array<PreparedDataset, kOfEachKind> with_noise;
  std::array<PreparedDataset, kOfEachKind> with_drift;  ///< and with GNSS drift besides
};

/// What is common to all synthetic datasets of one fit.
struct SyntheticSensors {
  double noise_scale = 1.0;  ///< of the sensor noise, in units of what the data show
  std::array<std::uint64_t, UndisturbedReplicates::kOfEachKind> seeds{};
  std::size_t threads = 1;  ///< never changes the result
};

/// Simulates undisturbed replicates by the model of the stacked unknowns `theta`. Nothing when one
/// of them diverges.
std::optional<UndisturbedReplicates> SimulateUndisturbed(const FittedData& fitted,
                                                         const Eigen::VectorXd& theta,
                                                         const SyntheticSensors& sensors);

/// The disturbance that the residuals of the fit show in excess of the sensors' part, which is
/// taken from the residuals of `theta` in `undisturbed`: EstimateDisturbance(). Requires:
/// `undisturbed` simulated with `theta`.
Disturbance DisturbanceFromResiduals(const FittedData& fitted, const Eigen::VectorXd& theta,
                                     const UndisturbedReplicates& undisturbed);

}  // namespace telltale
