#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include <Eigen/Core>

#include "telltale/core/estimation/weak_form/disturbance_estimate.hpp"
#include "telltale/core/uncertainty/fit_simulation.hpp"

namespace telltale {

/// What is common to all synthetic datasets of one fit.
struct ReplicateSensors {
  static constexpr std::size_t kOfEachKind = 2;  ///< replicates free of disturbance

  double noise_scale = 1.0;  ///< of the sensor noise, in units of what the data show
  std::array<std::uint64_t, kOfEachKind> seeds{};
  std::size_t threads = 1;  ///< never changes the result
};

/// What the sensors alone leave in the residuals of the stacked unknowns `theta`: the
/// autocovariances of residuals in synthetic datasets that the model of `theta` makes free of
/// disturbance, with sensor noise, and with GNSS drift besides. Nothing when one of them diverges.
/// Memory: one synthetic dataset a thread.
std::optional<SensorAutocovariances> SimulateSensorAutocovariances(const FittedData& fitted,
                                                                   const Eigen::VectorXd& theta,
                                                                   const ReplicateSensors& sensors);

}  // namespace telltale
