#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "data/prepared_dataset.hpp"
#include "estimation/weak_iv.hpp"
#include "vessel/disturbance.hpp"

namespace telltale {

struct TwinCorrectionOptions {
  std::size_t twins = 40;  ///< [8, 1000], half of them about the first estimate
  std::uint64_t seed = 1;
  std::size_t threads = 1;       ///< never changes the result
  double noise_scale = 1.0;      ///< sensor noise of the twins against what the data show
  double time_scale = 1.0;       ///< their disturbance's time constant against what the data show
};

/// Shapes: theta and covariance over the stacked unknowns of the WeakFit.
struct TwinCorrection {
  Eigen::VectorXd theta;       ///< corrected for bias
  Eigen::MatrixXd covariance;  ///< of the clusters, calibrated, with what few twins leave open
  double calibration = 1.0;    ///< factor on standard errors by which the twins' own intervals hold
  Eigen::MatrixXd joint_covariance;  ///< the same, calibrated so that joint ellipsoids hold
  double degrees_of_freedom = 0.0;  ///< of Student's t for intervals
  Disturbance disturbance;
  std::size_t solved = 0;    ///< twins of the last round that could be estimated
  std::size_t failures = 0;  ///< twins of both rounds that could not
};

/// Bias correction and calibration by simulating the whole pipeline, docs/model.md (33):
/// the disturbance is judged from the residuals, twins of the data set are sailed with the damped
/// estimate, measured, prepared and estimated again, and what they are off by on average is taken
/// from the estimate; the second half of the twins repeats that about the corrected one, since the
/// bias itself moves with the coefficients. How often the twins' own intervals hold says by what
/// the standard errors must be stretched: one factor for all coefficients, from the pooled 95 %
/// quantile of |theta* - mean| / se*.
/// progress is called by one thread at a time. Nothing when fewer than half of the twins of a round can be estimated.
std::optional<TwinCorrection> CorrectWithTwins(
    const PreparedDataset& dataset, const RegressionOptions& regression, const WeakFit& fit,
    const std::array<std::vector<std::size_t>, 3>& columns, const WeakIvOptions& options,
    const TwinCorrectionOptions& twins, const std::function<void(double fraction)>& progress = {});

}  // namespace telltale
