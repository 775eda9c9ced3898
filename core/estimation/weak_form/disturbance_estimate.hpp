#pragma once

#include <array>

#include <Eigen/Core>

#include "telltale/core/data/prepared_dataset.hpp"
#include "telltale/core/estimation/weak_form/weak_fit.hpp"
#include "telltale/core/estimation/weak_form/weak_form.hpp"
#include "telltale/core/vessel/disturbance.hpp"

namespace telltale {

/// The lags, in supports, of the autocovariances that a disturbance is fitted to.
inline constexpr std::size_t kDisturbanceLags = 10;

/// The residuals of each answered equation that `theta`, stacked as in the fit, leaves in another
/// dataset of the same boat. `problem`: of that dataset.
std::array<Eigen::VectorXd, 3> ResidualsOf(const WeakFit& fit, const Eigen::VectorXd& theta,
                                           const PreparedDataset& dataset,
                                           const WeakProblem& problem);

/// The part of each equation's residual autocovariance that sensors cause, kDisturbanceLags long.
struct SensorAutocovariances {
  SensorAutocovariances();

  std::array<Eigen::VectorXd, 3> noise;  ///< of white sensor noise
  std::array<Eigen::VectorXd, 3> drift;  ///< per squared metre of GNSS drift within a second
};

/// Fits a first-order Gauss-Markov disturbance to each equation's residuals. Model: its
/// autocovariance, passed through the smoothing filter and the test function and reduced by what
/// the fitted coefficients take up, is least-squares fitted to the autocovariance of the residuals
/// less the sensors' part. GNSS drift is reported only where it explains at least half of the
/// misfit that the disturbance alone leaves.
Disturbance EstimateDisturbance(const PreparedDataset& dataset, const WeakFit& fit,
                                const SensorAutocovariances& sensor_autocovariances);

}  // namespace telltale
