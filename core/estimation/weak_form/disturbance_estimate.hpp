#pragma once

#include <array>

#include <Eigen/Core>

#include "telltale/core/data/prepared_dataset.hpp"
#include "telltale/core/estimation/weak_form/weak_form.hpp"
#include "telltale/core/estimation/weak_form/weak_iv.hpp"
#include "telltale/core/vessel/disturbance.hpp"

namespace telltale {

/// Lags of an autocovariance from which a disturbance is judged.
inline constexpr std::size_t kDisturbanceLags = 10;

/// The residuals that `theta`, stacked as in the fit, leaves in another dataset of the same boat.
std::array<Eigen::VectorXd, 3> ResidualsOf(const WeakFit& fit, const Eigen::VectorXd& theta,
                                           const PreparedDataset& dataset,
                                           const WeakProblem& problem);

/// What sensors alone leave in each equation: autocovariances of its residuals, kDisturbanceLags
/// long.
struct SensorAutocovariances {
  SensorAutocovariances();

  std::array<Eigen::VectorXd, 3> noise;  ///< by their white noise
  std::array<Eigen::VectorXd, 3> drift;  ///< besides, by fixes that wander off 1 m within a second
};

/// The disturbance behind the residuals: sigma^2 and time constant whose autocovariance, seen
/// through the filter and the test function and less what the coefficients have taken up of it,
/// comes nearest to what the residuals show beyond the sensors' part. Fixes are found to wander
/// where that explains half and more of what a disturbance alone does not.
Disturbance EstimateDisturbance(const PreparedDataset& dataset, const WeakFit& fit,
                                const SensorAutocovariances& sensor_autocovariances);

}  // namespace telltale
