#pragma once

#include <array>

#include <Eigen/Core>

#include "telltale/core/diagnosis/residuals/free_runs.hpp"
#include "telltale/core/diagnosis/residuals/spectral_peak.hpp"

namespace telltale {

/// Mean over windows of the outer product of the errors that an acceleration of one frequency and
/// random phase leaves, per squared amplitude, for each axis: surge, sway, yaw.
using ResponseMoments = std::array<Eigen::MatrixXd, 3>;

/// Model: the mean over the phases of cos and sin, from small accelerations that stay linear.
/// `errors` are those of the boat itself.
ResponseMoments ResponseMomentsAt(double frequency_rad_s, const FreeRuns& runs,
                                  const AugmentedModel& boat, const Eigen::MatrixXd& errors);

/// The covariance that accelerations of a spectral peak add to a window's errors: the sum over axes
/// of squared amplitudes times response moments, the mean over the peak's frequencies. Shapes: rows
/// x rows.
Eigen::MatrixXd ErrorCovarianceOf(const SpectralPeak& peak, const FreeRuns& runs,
                                  const AugmentedModel& boat, const Eigen::MatrixXd& errors);

}  // namespace telltale
